#include "engine/load/images/memory_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "accel/tracer.h"

namespace rayengine {

namespace {

[[noreturn]] void fail(int error) {
  throw Error(std::string("cannot make a file in memory: ") + std::strerror(error) + "; ask for a smaller one");
}

}  // namespace

MemoryFile::MemoryFile(std::size_t most) : descriptor_(memfd_create("rayengine", MFD_CLOEXEC)) {
  if (descriptor_ < 0) fail(errno);
  int error = posix_fallocate(descriptor_, 0, static_cast<off_t>(most));
  if (error == 0 && ftruncate(descriptor_, 0) != 0) error = errno;
  if (error == 0) return;
  close(descriptor_);
  fail(error);
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::vector<unsigned char> MemoryFile::content() const {
  struct stat status {};
  fstat(descriptor_, &status);
  std::vector<unsigned char> bytes(static_cast<std::size_t>(status.st_size));
  std::ifstream file(name(), std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), status.st_size)) throw Error("cannot read a file in memory");
  return bytes;
}

}  // namespace rayengine
