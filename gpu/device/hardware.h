#pragma once

namespace rayengine {

/// Whether the kernel shows a device that could be a GPU. Takes microseconds and loads no driver; false is sure, so far
/// as Linux goes, and true is a hope.
bool may_have_gpu();

/// Throws Error when EGL has no device (or not that of this number) that is more than a renderer in software.
void require_hardware(int device);

}  // namespace rayengine
