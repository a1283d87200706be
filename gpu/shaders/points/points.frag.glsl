// What comes to the targets of a pixel. Of large vertices it is worked out here, as in the paper. Of small ones it comes with the
// point: devices shade several vertices in step, but of several pixels only that which the point covers.
layout(location = 0) flat in SHOWN_TYPE shown[SHOWN];
layout(location = 0) out vec4 color[TARGETS];

void main() {
#ifdef FAT
  color = brought_by(from_record(shown));
#else
  color = shown;
#endif
}
