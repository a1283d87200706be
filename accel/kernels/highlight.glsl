// The highlight that a surface shows of a light of unit colour. Source: Blinn, "Models of Light Reflection for Computer
// Synthesized Pictures" (1977). Directions have unit length; the normal faces the eye, `view` points to it.
KERNEL REAL highlight(REAL shininess, VEC3 normal, VEC3 to_light, VEC3 view) {
  VEC3 half_way = VEC3(to_light.x + view.x, to_light.y + view.y, to_light.z + view.z);
  REAL along = (normal.x * half_way.x + normal.y * half_way.y) + normal.z * half_way.z;
  REAL size2 = (half_way.x * half_way.x + half_way.y * half_way.y) + half_way.z * half_way.z;
  REAL none = 0;
  REAL cosine2 = pick(along > 0, along * along / size2, none);  // c^s is (c^2)^(s / 2), without a root
  // Below e^-32, which no picture shows, it is none: libraries take their time over what underflows. x^h <= e^(-h (1 - x)).
  REAL half_shininess = shininess / 2;
  cosine2 = pick(half_shininess * (1 - cosine2) > 32, none, cosine2);
  return pick(along > 0, power(cosine2, half_shininess), none);
}
