#!/bin/bash
# One binary runs on any x86-64: a function that a file built for AVX shares with others (an inline function of a header,
# not inlined) could be the copy that the linker keeps, and would then run on processors without AVX.
# Arguments: nm, and the object files built for AVX.
set -euo pipefail
nm=$1
shift
(($# > 0)) || { echo "no object files built for AVX"; exit 1; }
for object in "$@"; do
  symbols=$("$nm" -C --defined-only "$object")
  if grep -E ' [WVu] ' <<<"$symbols"; then
    echo "$object: shares the above with files built for any x86-64; inline it, or make it static"
    exit 1
  fi
done
