// What the kernels need to be GLSL. The same names are C++ in kernels.h.
#define KERNEL
#define REAL float
#define VEC3 vec3
#define BOOL bool
#define OUT(T) out precise T // what leads to it is computed as written: watertight triangles rest on it
#define REAL_MAX 3.402823466e38
#define ROUNDINGS(n) (float(n) * 5.9604644775390625e-8)

bool both(bool a, bool b) { return a && b; }
bool either(bool a, bool b) { return a || b; }
float pick(bool condition, float yes, float no) { return condition ? yes : no; }
float root(float a) { return sqrt(a); }
float power(float a, float b) { return pow(a, b); }
float whole(float a) { return floor(a); }
float magnitude(float a) { return abs(a); }
float smaller(float a, float b) { return a < b ? a : b; }
float larger(float a, float b) { return a > b ? a : b; }
