#include "engine/load/images/codec.h"

#include "engine/load/images/formats.h"

extern "C" [[gnu::visibility("default")]] const rayengine::ImageCodec rayengine_image_codec = {
    rayengine::images::read, rayengine::images::check_format, rayengine::images::check_sides,
    rayengine::images::encode};
