#!/bin/bash
# Installs the build tree into a folder of its own, builds examples/embed against that as a host would, by CMake and by
# pkg-config, and compares what it prints. Arguments: source folder, build folder, compiler, compiler flags.
set -euo pipefail
source=$1 build=$2 compiler=$3 flags=${4:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
prefix=$folder/prefix

check() {
  "$1" | diff "$source/tests/install/expected.txt" -
  ! ldd "$1" | grep -E 'OpenImageIO|OpenMesh' || { echo "an embedding application inherits the above"; exit 1; }
}

echo "install"
cmake --install "$build" --prefix "$prefix" >"$folder/log" || { cat "$folder/log"; exit 1; }

echo "every installed header compiles"
(cd "$prefix/include" && find rayengine -name '*.h' -printf '#include <%p>\n') |
  $compiler -std=c++20 $flags -Wall -Wextra -Werror -fsyntax-only -I"$prefix/include" -x c++ -

echo "by CMake"
cmake -S "$source/examples/embed" -B "$folder/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_CXX_FLAGS="$flags" >"$folder/log" || { cat "$folder/log"; exit 1; }
cmake --build "$folder/cmake"
check "$folder/cmake/embed"

echo "by pkg-config"
export PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name rayengine.pc)")
$compiler -std=c++20 $flags -o "$folder/embed" "$source/examples/embed/main.cpp" $(pkg-config --cflags --libs rayengine)
check "$folder/embed"

if [[ -x $prefix/bin/rayengine ]]; then
  echo "the command, on the sample scene that came along"
  (cd "$folder" && "$prefix/bin/rayengine" render --size 16x16 && test -s sphereflake.png)
fi
