// A ray's whole way through the grid. After the sources in shaders/grid.
layout(location = 18) uniform uint first_list;  // of what has no bounds, or none

void find() {
  uvec4 place = uvec4(first_list, none, first_list == none ? traversing : intersecting, 0);
  while (place.z != done) place = place.z == traversing ? traverse(place) : intersect(place);
}
