// The highlight that a surface shows of a light of unit colour. Source: Blinn, "Models of Light Reflection for Computer
// Synthesized Pictures" (1977). Directions have unit length; the normal faces the eye, `view` points to it.
KERNEL REAL highlight(REAL shininess, VEC3 normal, VEC3 to_light, VEC3 view) {
  VEC3 half_way = VEC3(to_light.x + view.x, to_light.y + view.y, to_light.z + view.z);
  REAL along = (normal.x * half_way.x + normal.y * half_way.y) + normal.z * half_way.z;
  REAL size = root((half_way.x * half_way.x + half_way.y * half_way.y) + half_way.z * half_way.z);
  REAL none = 0;
  REAL cosine = larger(along / size, none);
  // Below e^-32, which no picture shows, it is none: libraries take their time over what underflows. c^s <= e^(-s (1 - c)).
  cosine = pick(shininess * (1 - cosine) > 32, none, cosine);
  return pick(along > 0, power(cosine, shininess), none);
}
