#include "engine/load/npy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/load/text.h"
#include "tests/load/expect_error.h"
#include "tests/load/file_limit.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

std::string npy(const std::string& header, const std::string& data, char version = 1) {
  std::string bytes("\x93NUMPY");
  bytes += version;
  bytes += '\0';
  bytes += static_cast<char>(header.size() & 0xFF);
  bytes += static_cast<char>(header.size() >> 8);
  if (version > 1) bytes += std::string(2, '\0');
  return bytes + header + data;
}

template <class T>
std::string values(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    const T value = T(i) / T(10);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

/// The Python that Debian's packages serve, which need not be the first on the path.
const std::string python = "/usr/bin/python3";

bool has_numpy() { return std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) == 0; }

class Npy : public testing::Test {
 protected:
  void fails(const std::string& content, const std::string& what) {
    const fs::path file = folder.write("rays.npy", content);
    expect_error([&] { read_rays(file); }, "rays.npy", what);
  }

  /// Runs a script of NumPy in the folder; it fails by an assertion.
  void expect_python(const std::string& script) {
    folder.write("check.py", "import numpy as np\n" + script);
    EXPECT_EQ(std::system(("cd '" + folder.path().string() + "' && " + python + " check.py").c_str()), 0) << script;
  }

  test::TemporaryFolder folder;
};

TEST_F(Npy, ReadsRaysOfBothPrecisionsAndAllVersions) {
  for (const char version : {1, 2, 3})
    for (const char* dtype : {"<f8", "=f8", "|f8", "f8"}) {
      const std::string header = std::string("{'descr': '") + dtype + "', 'fortran_order': False, 'shape': (2, 8), }\n";
      const auto rays = read_rays(folder.write("rays.npy", npy(header, values<double>(16), version)));
      ASSERT_EQ(rays.size(), 2u);
      EXPECT_EQ(rays[0].origin, glm::dvec3(0, 0.1, 0.2));
      EXPECT_EQ(rays[0].tmin, 0.3);
      EXPECT_EQ(rays[1].direction, glm::dvec3(1.2, 1.3, 1.4));
      EXPECT_EQ(rays[1].tmax, 1.5);
    }
  const auto rays = read_rays(
      folder.write("rays.npy", npy("{\"shape\":(1,8),\"fortran_order\":False,\"descr\":\"<f4\"}", values<float>(8))));
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_EQ(rays[0].direction.y, double(0.5f));
  EXPECT_EQ(rays[0].tmax, double(0.7f));
}

TEST_F(Npy, RejectsOtherFiles) {
  const std::string f8 = "{'descr': '<f8', 'fortran_order': False, 'shape': ";
  fails("", "is not a NumPy file");
  fails("\x93NUMPY\x01", "ends within its header");
  fails(npy(f8, "", 9), "NumPy format 9");
  fails(npy(f8 + "(1, 8)}", "").substr(0, 40), "ends within its header");
  fails(npy(f8 + "(1, 8)}", values<double>(7)), "ends before its 1 rows");
  fails(npy(f8 + "(18446744073709551615, 8)}", ""), "ends before its 18446744073709551615 rows");
  fails(npy(f8 + "(184467440737095516150, 8)}", ""), "has shape");
  fails(npy(f8 + "(8,)}", values<double>(8)), "has shape '(8,)'; rays have shape (N, 8)");
  fails(npy(f8 + "(1, 7)}", values<double>(8)), "has shape '(1, 7)'");
  fails(npy(f8 + "(1, 1, 8)}", values<double>(8)), "has shape");
  fails(npy(f8 + "(-1, 8)}", values<double>(8)), "has shape");
  fails(npy(f8 + "8", values<double>(8)), "has shape");
  fails(npy("{'descr': '<f8', 'fortran_order': True, 'shape': (1, 8)}", values<double>(8)), "Fortran order");
  fails(npy("{'descr': '>f8', 'fortran_order': False, 'shape': (1, 8)}", values<double>(8)), "dtype '>f8'");
  fails(npy("{'descr': '<i4', 'fortran_order': False, 'shape': (1, 8)}", values<double>(8)), "dtype '<i4'");
  fails(npy("{'descr': [('t', '<f8')], 'fortran_order': False, 'shape': (1, 8)}", ""), "dtype 'structured'");
  fails(npy("{'fortran_order': False, 'shape': (1, 8)}", values<double>(8)), "without 'descr'");
  fails(npy("{'descr'", ""), "without 'descr'");
  fails(npy("{'descr': ", ""), "without 'descr'");
  fails(npy("{'descr': '", ""), "dtype");
  expect_error([&] { read_rays(folder.path() / "none.npy"); }, "none.npy", "no such file");
  expect_error([&] { read_rays(folder.path()); }, folder.path().string(), "is not a file");
}

TEST_F(Npy, WritesRaysThatReadBack) {
  std::vector<Ray> rays(3);
  rays[1] = {{0.1, -1e300, NAN}, -1, {1e-310, 2, 3}, infinity};
  write_rays(folder.path() / "rays.npy", rays);
  const auto back = read_rays(folder.path() / "rays.npy");
  ASSERT_EQ(back.size(), rays.size());
  EXPECT_EQ(std::memcmp(back.data(), rays.data(), rays.size() * sizeof(Ray)), 0);
  EXPECT_EQ(read_file(folder.path() / "rays.npy").size() % 64, 0u);
}

TEST_F(Npy, SpeaksWithNumPy) {
  if (!has_numpy()) GTEST_SKIP() << "no python3 with numpy";
  expect_python(
      "a = np.arange(24).reshape(3, 8) / 10\nnp.save('f8.npy', a)\nnp.save('f4.npy', a.astype('f4'))\n"
      "np.save('fortran.npy', np.asfortranarray(a))\nnp.save('empty.npy', a[:0])\n");
  EXPECT_EQ(read_rays(folder.path() / "f8.npy")[2].tmax, 2.3);
  EXPECT_EQ(read_rays(folder.path() / "f4.npy")[2].tmax, double(2.3f));
  EXPECT_TRUE(read_rays(folder.path() / "empty.npy").empty());
  expect_error([&] { read_rays(folder.path() / "fortran.npy"); }, "fortran.npy", "Fortran order");

  std::vector<Hit> hits(70'000);
  hits[69'999] = {1.5, 1e-9, 7, 9, 0.25f, 0.5f, {1, 2, 3}, status_hit | status_tie};
  write_hits(folder.path() / "hits.npy", hits);
  const std::vector<std::uint64_t> offsets = {0, 2, std::uint64_t{1} << 40};
  write_offsets(folder.path() / "hits.offsets.npy", offsets);
  write_rays(folder.path() / "rays.npy", std::vector<Ray>(2));
  expect_python(
      "h = np.load('hits.npy')\n"
      "assert h.dtype.names == ('t','object','primitive','u','v','nx','ny','nz','error','status'), h.dtype\n"
      "assert h.dtype.itemsize == 48 and h.shape == (70000,)\n"
      "assert h[69999].tolist() == (1.5, 7, 9, 0.25, 0.5, 1, 2, 3, 1e-9, 5), h[69999]\n"
      "assert np.isinf(h['t'][:-1]).all() and (h['object'][:-1] == 0xFFFFFFFF).all() and (h['status'][:-1] == "
      "0).all()\n"
      "o = np.load('hits.offsets.npy')\n"
      "assert o.dtype == np.dtype('<u8') and o.tolist() == [0, 2, 2**40]\n"
      "r = np.load('rays.npy')\n"
      "assert r.dtype == np.dtype('<f8') and r.tolist() == [[0, 0, 0, 0, 0, 0, 1, np.inf]] * 2\n");
}

TEST_F(Npy, LeavesNothingOnAFullDisk) {
  const std::vector<Hit> hits(100'000);
  expect_error(
      [&] {
        const test::FileLimit limit(1'000'000);
        write_hits(folder.path() / "hits.npy", hits);
      },
      "hits.npy", "cannot write");
  EXPECT_TRUE(fs::is_empty(folder.path()));
  expect_error([&] { write_hits(folder.path() / "none" / "hits.npy", hits); }, "hits.npy", "No such file or directory");
}

}  // namespace
}  // namespace rayengine
