#!/usr/bin/env bash
# Builds the consumers against the installed package as pkg-config describes it, and runs them.
# pkg_config_test.sh PREFIX/LIBDIR WORK C_DOMAIN CPP_DOMAIN [compiler flags...]; CC and CXX name the compilers.
set -euo pipefail
libdir="$1" work="$2" c_domain="$3" cpp_domain="$4"
shift 4
consumer="$(cd "$(dirname "$0")/consumer" && pwd)"
mkdir -p "$work"

export PKG_CONFIG_PATH="$libdir/pkgconfig"
read -ra flags <<<"$(pkg-config --cflags liloc-client)"
read -ra libraries <<<"$(pkg-config --libs liloc-client)"
warnings=(-Wall -Wextra -Werror)
"${CC:-cc}" -std=c99 -pedantic-errors "${warnings[@]}" "$@" "${flags[@]}" "$consumer/consumer.c" \
  -o "$work/consumer_c" "${libraries[@]}" -lm "-Wl,-rpath,$libdir"
"${CXX:-c++}" -std=c++17 -pedantic-errors "${warnings[@]}" "$@" "${flags[@]}" "$consumer/consumer.cpp" \
  -o "$work/consumer_cpp" "${libraries[@]}" "-Wl,-rpath,$libdir"

# The public headers lead to nothing but the standard library.
for header in client.h client.hpp; do
  "${CXX:-c++}" -std=c++17 -M -x c++ "${flags[@]}" - <<<"#include <liloc/$header>" >"$work/$header.needs"
  if grep -Ei 'eigen|/pcl|/dds|expected|/fmt' "$work/$header.needs"; then
    echo "liloc/$header leads to these headers; a robot has them not" >&2
    exit 1
  fi
done

"$work/consumer_c" "$c_domain"
"$work/consumer_cpp" "$cpp_domain"
