#!/usr/bin/env bash
# Builds whit with Clang, its warnings being errors, and runs the tests of what depends most on the
# compiler: the kernels on every SIMD target, arithmetic, scenes and the readers of files.
#   tests/clang.sh [NAME...]    the tests NAME_test instead of the default ones
# Without Clang it says so and succeeds; with CI=true it fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
tests=("$@")
[ $# -gt 0 ] || tests=(
  vec3 affine effects nearest_name worker_pool cgroup_quota texture sky camera mesh bake mending
  finalize validate scene_effects sample_pattern pixel_edges light_shares
  twins encode_display effects_kernels alpha_map edge_hits
  polygon decode_queue scene_syntax scene_items scene_paths scene_settings obj_faces obj_hostile mtl
  gltf_data gltf_hostile ply read_image exr png atomic_file merge_images)

if ! command -v clang++ >/dev/null; then
  echo "!! Clang is not installed: it is NOT checked (apt-get install clang)" >&2
  [ -z "${CI:-}" ]
  exit
fi
cmake --preset clang -DWHIT_WERROR=ON >/dev/null
cmake --build --preset clang --parallel "$(nproc)" --target whit "${tests[@]/%/_test}"
for name in "${tests[@]}"; do
  echo "-- $name"
  WHIT_SOURCE_DIR=$root "build-clang/tests/${name}_test" --gtest_brief=1 | tail -40
done
