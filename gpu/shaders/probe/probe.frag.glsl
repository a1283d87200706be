layout(location = 0) out uint result;

void main() { result = answer(int(gl_FragCoord.y) * SIDE + int(gl_FragCoord.x)); }
