// One arithmetic question, answered in the bits of a float. The operands come from a texture, so that nothing is known when
// the shader is compiled. QUESTION is one of the functions below.
layout(binding = 0) uniform usamplerBuffer operands;

// What a * b + c gives when nothing is said about it.
float contraction(float a, float b, float c) { return a * b + c; }

float precise_product_sum(float a, float b, float c) {
  precise float result = a * b + c;
  return result;
}

float fused(float a, float b, float c) { return fma(a, b, c); }

// The rounding error of a + b. Source: Knuth's TwoSum.
float two_sum(float a, float b, float c) {
  precise float s = a + b;
  precise float bb = s - a;
  precise float e = (a - (s - bb)) + (b - bb);
  return e;
}

// The rounding error of a * b. Source: Dekker's product, with Veltkamp's splitting.
float dekker(float a, float b, float c) {
  precise float ca = 4097.0 * a;
  precise float ah = ca - (ca - a);
  precise float al = a - ah;
  precise float cb = 4097.0 * b;
  precise float bh = cb - (cb - b);
  precise float bl = b - bh;
  precise float p = a * b;
  precise float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
  return e;
}

float tiny(float a, float b, float c) { return a * b; }

float quotient(float a, float b, float c) { return a / b; }

float square_root(float a, float b, float c) { return sqrt(abs(a)); }

uint answer(int index) {
  uvec4 bits = texelFetch(operands, index);
  return floatBitsToUint(QUESTION(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z)));
}
