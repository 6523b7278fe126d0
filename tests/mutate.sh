#!/usr/bin/env bash
# Plants known mistakes one at a time in a copy of the sources, builds the tests that have to catch
# them (those of the hard cases, or others that testedBy names), and sees that some test turns red.
# Slow: most mistakes rebuild kernels.
#   tests/mutate.sh              all
#   tests/mutate.sh NAME...      these
#   tests/mutate.sh --list       their names
#   tests/mutate.sh --check      only sees that the place of each is there, once; builds nothing
# Exits 1 when a mistake survives or has lost its place. The copy is $WHIT_MUTATE_DIR, else build/mutate;
# it is kept, so that the next run is faster.
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
copy=${WHIT_MUTATE_DIR:-$root/build/mutate}
. "$root/tests/compiler_cache.sh"
useCompilerCache "$copy"
planted=0
red=
survived=()
target=hard_test filter=
declare -A green  # tests that pass without a mistake

# testedBy TARGET FILTER: the tests that have to catch the mistakes that follow.
testedBy() { target=$1 filter=$2; }

# plant NAME FILE OLD NEW: OLD occurs once in FILE.
plant() {
  local name=$1 file=$2 old=$3 new=$4 text rest count
  if [ "${#wanted[@]}" -gt 0 ] && [[ ! " ${wanted[*]} " =~ " $name " ]]; then return; fi
  planted=$((planted + 1))
  if [ "$mode" = list ]; then echo "$name"; return; fi
  text=
  if [ -f "$root/$file" ]; then text=$(<"$root/$file"); fi
  rest=${text//"$old"/}
  count=$(((${#text} - ${#rest}) / ${#old}))
  if [ $count -ne 1 ]; then
    echo "$name: its place is found $count times in $file, not once: $old" >&2
    survived+=("$name (no place)")
    return
  fi
  if [ "$mode" = check ]; then return; fi
  if [ -z "${green[$target $filter]:-}" ]; then
    if ! try; then
      echo "unchanged: not all green, see $copy/build.log and test.*.log beside it: $red" >&2
      exit 1
    fi
    green[$target $filter]=yes
    echo "unchanged: $target $filter is all green, as it must be"
  fi
  # An interrupted run must not leave its mistake to the next.
  # shellcheck disable=SC2064  # the file of now
  trap "cp '$root/$file' '$copy/$file'" EXIT
  printf '%s\n' "${text%%"$old"*}$new${text#*"$old"}" >"$copy/$file"
  try
  case $? in
    0) echo "$name: SURVIVED"; survived+=("$name") ;;
    1) echo "$name: caught by $red" ;;
    2) echo "$name: does not build, see $copy/build.log"; survived+=("$name (not built)") ;;
  esac
  cp "$root/$file" "$copy/$file"
}

# hardCases SHARD: half of the tests. Image hashes would see every mistake and show no hard case.
hardCases() {
  WHIT_SOURCE_DIR=$copy GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$1 \
    timeout 600 "$copy/build/tests/hard_test" --gtest_filter=-Hard/HashTest.* >"$copy/test.$1.log" 2>&1
}

# As the tests of CMake run them, with a home of their own.
otherTests() {
  mkdir -p "$copy/build/tests/home"
  HOME=$copy/build/tests/home WHIT_SOURCE_DIR=$copy \
    timeout 600 "$copy/build/tests/$target" --gtest_filter="$filter" >"$copy/test.0.log" 2>&1
}

# Builds and tests the copy as it is now: 0 all green, 1 red, 2 not built. What is red goes to $red.
try() {
  local shard status=0
  cmake --build "$copy/build" --target "$target" >"$copy/build.log" 2>&1 || return 2
  if [ "$target" != hard_test ]; then
    otherTests || status=$?
    red=$(sed -n 's|^\[  FAILED  \] \([A-Za-z0-9_/.]*\) (.*|\1|p' "$copy/test.0.log" | paste -sd' ')
    [ -n "$red" ] || red="(the program ended with status $status)"
    [ $status -eq 0 ] || return 1
    return 0
  fi
  hardCases 0 &
  hardCases 1 || status=$?
  wait $! || status=$?
  red=$(sed -n 's|^\[  FAILED  \] Hard/CaseTest.Holds/\([A-Za-z0-9]*\), where.*|\1|p' \
    "$copy"/test.?.log | sort -Vu | paste -sd' ')
  # A program that was ended has no list of what failed: it was at the last test that it began.
  for shard in 0 1; do
    if ! grep -q '^\[  PASSED  \]' "$copy/test.$shard.log"; then
      red+=" $(sed -n 's|^\[ RUN      \] Hard/CaseTest.Holds/||p' "$copy/test.$shard.log" | tail -1)"
      red+=" (the program ended with status $status)"
    fi
  done
  red=${red# }
  [ $status -eq 0 ] || return 1
}

mutations() {
  plant fixed-epsilon simd/new_rays-inl.h \
    'MulAdd3(ng, clearance.offset,' 'MulAdd3(ng, Set(1e-3f),'
  plant no-offset simd/new_rays-inl.h \
    'MulAdd3(ng, clearance.offset,' 'MulAdd3(ng, Zero(),'
  plant normal-offset-only simd/new_rays-inl.h 'Neg(clearance.viewOffset)' 'Zero()'
  plant wrong-offset-side simd/add_impulses.cpp \
    'ChildOrigin(job, lanes, i, -1.0f)' 'ChildOrigin(job, lanes, i, 1.0f)'
  plant approximate-distance simd/packets.cpp \
    'HitPoint p{Div(Dot(normal, t.corner), slope),' \
    'HitPoint p{Mul(Div(Dot(normal, t.corner), slope), Set(d, 1.0f + 0x1p-20f)),'
  plant unfactored-fresnel simd/lobes-inl.h \
    'const VF g2 = MulThenAdd(c, c, k);' \
    'const VF g2 = Add(Sub(Mul(eta, eta), one), Mul(c, c));'
  plant no-total-reflection simd/lobes-inl.h \
    'f = IfThenElse(total, one, Min(f, one));' \
    'f = IfThenElse(total, zero, Min(f, one));'
  plant same-index-reflects simd/lobes-inl.h 'f = IfThenElse(straight, zero, f);' ''
  plant light-behind-surface simd/find_radiance_and_shadow_rays.cpp \
    'And(front, Gt(Dot(ns, toLight), zero))' 'Gt(Dot(ns, toLight), zero)'
  plant shadow-ray-too-long simd/find_radiance_and_shadow_rays.cpp \
    'infinity() : kShadowReach)' 'infinity() : kShadowReach + 0x1p-10f)'
  plant light-without-radius simd/find_radiance_and_shadow_rays.cpp \
    'Max(distanceSquared, radiusSquared_)' \
    'distanceSquared'
  plant flipped-normal simd/surface-inl.h \
    'return IfThenElse(entering, Set(1.0f), Set(-1.0f));' \
    'return (void)entering, Set(1.0f);'
  plant normal-of-tiny-triangle simd/surface-inl.h \
    'const VF scale = InverseExponent(largest);
  const V3 unit' 'const VF scale = Set(1.0f); (void)largest;
  const V3 unit'
  plant unmasked-lane simd/add_impulses.cpp \
    'const size_t live = HWY_MIN(Lanes(d), n - i);' 'const size_t live = Lanes(d);'
  plant dropped-lane simd/add_impulses.cpp \
    'return compactor.Count();' 'return compactor.Count() - (compactor.Count() > 3 ? 1 : 0);'
  plant no-elevation simd/add_impulses.cpp \
    'const MF low = Lt(height, elevation);' 'const MF low = Lt(height, Set(-2.0f)); (void)elevation;'
  plant wrong-bend simd/add_impulses.cpp \
    'MulAdd3(lanes.ns, Neg(interface.bend), lanes.direction)' \
    'MulAdd3(lanes.ns, interface.bend, lanes.direction)'
  plant nan-throughput simd/add_impulses.cpp \
    'And(live, And(worth, Gt(child.largest, Zero())))' \
    'And(live, Or(worth, Ne(throughput, throughput)))'
  plant media-not-removed simd/material-inl.h \
    'return IfThenElse(byteIs(stack), above, result);' 'return result;'
  plant far-texture-coordinate simd/texture-inl.h \
    'Le(Abs(s), Set(1048576.0f))' 'Le(Abs(s), Set(1e38f))'
  plant stale-tfar simd/packets.cpp \
    'from.tFar ? load(from.tFar) : hn::Inf(d);' \
    'from.tFar ? load(from.tFar)
        : LoadU(d, WordsOf<kWidth>(to, i) + packet_column::tFar * kWidth);
    if (!from.tFar) tFar = IfThenElse(Gt(tFar, Zero(d)), tFar, hn::Inf(d));'
  plant stale-hit src/accel/accel.cpp \
    'indices(group.count)) {
      std::fill_n(group.packets[p].hit.geomID' \
    'indices(group.count)) {
      if (begin == 0) std::fill_n(group.packets[p].hit.geomID'
  plant off-by-one-tail simd/packets.cpp \
    'hn::FirstN(d, i < n ? n - i : 0)' 'hn::FirstN(d, i < n ? n - i - (n > 1 ? 1 : 0) : 0)'
  plant bad-rays-traced simd/packets.cpp \
    'And(there, Traceable(d, ox, oy, oz, dx, dy, dz, reach))' 'there'
  plant no-retry src/render/renderer.cpp \
    'options_.retry && isEnclosed(scene_, *accel_)' 'false && isEnclosed(scene_, *accel_)'
  plant eye-in-vacuum simd/generate_rays.cpp 'Set(camera.media)' 'Zero(du)'
  plant media-never-entered src/surfaces/initial_media.cpp \
    '++entered[surface.medium];' ''
  plant eye-beside-the-surface src/surfaces/initial_media.cpp \
    '|| liesOnDielectric(scene, effects, intersector, frame.eye);' ';'
  plant glass-before-opaque src/bake/facet.h \
    'std::tuple(opaque, medium' 'std::tuple(!opaque, medium'
  plant not-robust src/accel/embree_scene.cpp 'options.robust ? RTC_SCENE_FLAG_ROBUST' \
    'false ? RTC_SCENE_FLAG_ROBUST'
  plant sphere-in-floats simd/meet_sphere.cpp \
    'const auto inside = Sub(one, DotOf<D>(nearest, nearest));' \
    'const auto inside = PromoteTo(d, hn::DemoteTo(df, Sub(Mul(b, middle),
                                                                    Sub(DotOf<D>(f, f), one))));'
  plant sphere-without-far-side simd/meet_sphere.cpp \
    'IfThenElse(Gt(low, start), low, high)' 'IfThenElse(Gt(low, start), low, low)'
  plant sphere-without-lower-half simd/surface-inl.h \
    '{IfThenElse(below, foldedU, u), IfThenElse(below, foldedV, v), height}' \
    '{u, v, height}; (void)foldedU, (void)foldedV, (void)below'
  plant sphere-inverse-transposed src/accel/sphere_geometry.cpp \
    'inverse.rows[row][column] = rows[row][column]' 'inverse.rows[row][column] = rows[column][row]'
  plant sphere-mirrored-inside-out src/bake/sphere.cpp \
    'record.outward = toGeometry.determinant() < 0 ? -1.0f : 1.0f;' 'record.outward = 1.0f;'
  plant sphere-without-offset simd/surface-inl.h \
    'surface.magnitude = Select3(s.on, magnitude, surface.magnitude);' \
    'surface.magnitude = Select3(s.on, Scale3(magnitude, Zero()), surface.magnitude);'
  plant spheres-in-any-order src/accel/sphere_geometry.cpp \
    'if (other.geometry != sphere.geometry) return false;' \
    'if (other.geometry <= sphere.geometry) return false;'

  testedBy images_test 'OverBackground.*:ChannelPng.*'
  plant background-twice src/core/display.cpp \
    '(double{linearOfCode(codes[c])} - behind) * covered;' \
    '(double{linearOfCode(codes[c])} - behind) * covered * covered;'
  plant data-png-as-srgb src/io/image/image_layers.cpp \
    'channel == Channel::albedo, metadata);' 'true, metadata);'
  testedBy io_test 'EveryProperty.*'
  plant wrap-t-of-s src/io/gltf/material.cpp 'readWrap(sampler["wrapT"])' 'readWrap(sampler["wrapS"])'
  plant specular-not-clamped src/io/gltf/material.cpp \
    'm_.f90 = readNumber(specular["specularFactor"], 1);' \
    'm_.f90 = readNumber(specular["specularFactor"], 1, -1e9, 1e9);'
  testedBy cli_test 'EveryOption.*:Program.*:DeadEnds.*:TurntableCommand.*:MemoryMb.*:Limits.*'
  plant too-little-energy-passes src/cli/compare.cpp \
    'std::fabs(d.energyRatio - 1) <= kMostEnergyOff' 'd.energyRatio - 1 <= kMostEnergyOff'
  plant merge-not-strict src/cli/merge.cpp 'warnings(common.render.strict)' 'warnings(false)'
  plant one-turn src/cli/render.cpp \
    'job_.turns * frame / job_.turntableFrames' '1.0 * frame / job_.turntableFrames'
  plant kilobytes-as-megabytes src/output/frame_summary.cpp \
    'renderer.memoryBytes()) / 1e6;' 'renderer.memoryBytes()) / 1e3;'
  plant max-memory-ignored src/command_line/parse_options.cpp \
    'common.load.maxMemoryBytes = common.maxMemoryGb
' 'common.load.maxMemoryBytes = false
'
  plant film-without-a-limit src/cli/render.cpp \
    'const std::uint64_t most = job.common.load.maxMemoryBytes;' \
    'const std::uint64_t most = 64ull << 30;'
  testedBy unit_test 'FailureOf.*:ThreadsWithin.*'
  plant no-memory-is-a-failure src/core/error.cpp \
    '{ExitStatus::limit, "out of memory"}' '{ExitStatus::checkFailed, "out of memory"}'
  plant quota-rounded-up src/core/machine_limits.cpp \
    'std::floor(quota + 0.001)' 'std::ceil(quota - 0.001)'
  testedBy serve_test 'PictureStream.*:Serving.Every*'
  plant last-row-of-a-tile viewer/serve/picture_stream.cpp \
    'y < part.y + part.height; ++y) {
    if (std::memcmp' 'y < part.y + part.height - 1; ++y) {
    if (std::memcmp'
  plant no-referrer-policy viewer/serve/server.cpp '{"Referrer-Policy", "no-referrer"},' ''

  testedBy images_test 'OverBackground.*:MergeImages.*:ImageLayers.*:ExrTest.*'
  plant exposure-over-background src/core/display.cpp \
    'std::exp2(static_cast<double>(options.exposure.ev))' '1.0'
  plant no-tone-curve-over-background src/core/display.cpp \
    'displayCodes(surfaces, scale, options.toneCurve)' \
    'displayCodes(surfaces, scale, ToneCurve::none)'
  plant combined-layer-not-preferred src/io/image/exr.cpp \
    'if (layer.empty() || isCombined) layer = found;' 'if (layer.empty() || !isCombined) layer = found;'
  plant half-floats-not-clamped src/io/image/exr.cpp \
    'std::clamp(pixel[c], -kLargest, kLargest)' 'std::max(pixel[c], -kLargest)'
  plant ndc-upside-down src/io/image/exr.cpp \
    'static_cast<float>(-1 / (pixel * image.height))' \
    'static_cast<float>(1 / (pixel * image.height))'
  plant merge-keeps-crop src/io/image/image_layers.cpp 'entry.first == "crop" ||' ''
  plant merge-keeps-first-layer src/io/image/image_layers.cpp \
    '        word = layers[k].words[from];' '        if (!covered[i]) word = layers[k].words[from];'

  testedBy unit_test 'FailureOf.*:MemoryLeft.*:RunnableTasks.*:ModelViews.*'
  plant memory-in-thousands src/core/machine_limits.cpp '1024 * kilobytes' '1000 * kilobytes'
  plant counts-itself-as-other-task src/core/machine_limits.cpp \
    'std::max(tasks - 1, 0)' 'std::max(tasks, 0)'
  plant azimuth-the-other-way src/make/model_view.cpp \
    'return {across * std::sin(azimuth), side.y, across * std::cos(azimuth)};' \
    'return {-across * std::sin(azimuth), side.y, across * std::cos(azimuth)};'
  plant zoom-in-rooms-ignored src/make/model_view.cpp \
    'std::tan(kWide * (std::numbers::pi / 360)) / scene.zoom' \
    'std::tan(kWide * (std::numbers::pi / 360))'
  plant no-thread-is-a-failure src/core/error.cpp \
    '{ExitStatus::limit, std::string("cannot start another thread: ")' \
    '{ExitStatus::checkFailed, std::string("cannot start another thread: ")'

  testedBy io_test 'Gltf*:Mtl.*:Ply.*:ReadFile.*'
  plant texture-turned-the-other-way src/io/gltf/material.cpp \
    'uv.uv = s * scale[1];' 'uv.uv = -s * scale[1];'
  plant nearest-by-min-filter src/io/gltf/material.cpp 'sampler["magFilter"]' 'sampler["minFilter"]'
  plant mask-without-alpha-factor src/io/gltf/material.cpp \
    'std::min(g.alphaCutoff / g.alpha, 1.0f)' 'g.alphaCutoff'
  plant absorbs-by-distance src/io/gltf/material.cpp '-logarithm / distance' '-logarithm * distance'
  plant texture-transform-without-set src/io/gltf/material.cpp \
    'readSet(t["texCoord"], uv.set)' 'uv.set'
  plant half-of-orthographic-height src/io/gltf/nodes.cpp \
    'static_cast<float>(2 * ymag)' 'static_cast<float>(ymag)'
  plant mtl-offset-v-the-other-way src/io/obj/mtl_reader.cpp \
    '1.0 - double{map.offset.y} - double{map.scale.y}' \
    '1.0 + double{map.offset.y} - double{map.scale.y}'
  plant mtl-scale-v-as-u src/io/obj/mtl_reader.cpp \
    'texture.uv.vv = double{map.scale.y}' 'texture.uv.vv = double{map.scale.x}'
  plant mtl-metalness-map-needs-pm src/io/obj/mtl_reader.cpp \
    'unit("pm", m.metallicRoughnessMap.exists() ? 1 : 0)' 'unit("pm", 0)'
  plant mtl-illum-5-as-3 src/io/obj/mtl_reader.cpp 'illum_ == 5 ? Rgb(1.0f) : highlight' 'highlight'
  plant ply-16-bit-colors-as-8 src/io/ply/ply_model.cpp \
    'if (white > 0) value /= white;' 'if (white > 0) value /= 255;'
  plant ply-face-v-flipped src/io/ply/ply_model.cpp \
    'static_cast<float>(face.coordinates[2 * i + 1])' \
    'static_cast<float>(1 - face.coordinates[2 * i + 1])'
  plant pointer-files-taken src/io/files.cpp \
    'bytes.starts_with("version https://git-lfs.github.com/spec/")' 'false'

  testedBy cli_test 'StageTable.*:RunJson.*:ProgressText.*:MemoryMb.*:Models.*:JsonResults.*:FarModels.*'
  plant minutes-as-hours src/output/frame_summary.cpp 'perSecond * 60);' 'perSecond * 3600);'
  plant lanes-not-in-percent src/output/frame_summary.cpp \
    'formatted("%.1f", 100 * lanesFilled(tally))' 'formatted("%.1f", lanesFilled(tally))'
  plant peak-memory-in-kilobytes src/output/json_report.cpp \
    'usage.ru_maxrss) * 1024 / 1e6;' 'usage.ru_maxrss) / 1e6;'
  plant waited-as-spent src/output/json_report.cpp \
    '{"waited", quantile(run.waitedMs, 0.5)}' '{"waited", quantile(run.writingMs, 0.5)}'
  plant fps-in-milliseconds src/output/json_report.cpp \
    'frame.frameMs > 0 ? 1e3 / frame.frameMs : 0' 'frame.frameMs > 0 ? 1 / frame.frameMs : 0'
  plant time-left-as-all-time src/command_line/progress_bar.cpp \
    'ms * (1 - fraction) / fraction / 1000' 'ms / fraction / 1000'
  plant info-memory-in-kilobytes src/cli/info.cpp \
    'scene.memoryBytes()) / 1e6' 'scene.memoryBytes()) / 1e3'
  plant options-of-models-as-presets src/cli/info.cpp \
    'value != optionText(stated, name)' 'value == optionText(stated, name)'
  plant efficiency-without-threads src/cli/bench.cpp '100 * alone / ms / threads' '100 * alone / ms'
  plant compare-files-unexposed src/cli/compare.cpp \
    'result.exposure = common.render.exposure.ev;' 'result.exposure = 0;'
  plant ray-tree-far-off src/cli/explain.cpp 'jsonOf(scene.inFile(n.position))' 'jsonOf(n.position)'

  testedBy cli_test 'Images.Resum*:Film.*:Options.*:Program.*:DeadEnds.*:Interrupt*:Limits.*:Render.*'
  plant resumes-another-target src/output/image_output.cpp \
    '(entry.first == "simd" && options.simd == "auto")' 'entry.first == "simd"'
  plant resumes-cut-off-images src/output/image_output.cpp \
    '  readImage(path, limits);
' \
    '  (void)limits;
'
  plant film-twice-as-fast src/output/film_pipe.cpp 'width, height, fps),' 'width, height, 2 * fps),'
  plant value-of-a-flag-ignored src/command_line/parse_options.cpp \
    'typed.value.value_or("true")' 'std::string("true")'
  plant ground-off src/command_line/parse_options.cpp 'set("/ground=true")' 'set("/ground=false")'
  plant bench-takes-both src/cli/bench.cpp 'job.common.given.contains(series.option),' 'false,'
  plant no-words-succeed src/cli/main.cpp 'return static_cast<int>(ExitStatus::usage);' 'return 0;'
  plant frames-backwards src/output/image_output.cpp \
    'if (!good || range.last < range.first) {' 'if (!good) {'
  plant tolerance-below-zero src/cli/compare.cpp \
    '{"tolerance", "X", 0},' '{"tolerance", "X"},'
  plant hang-up-not-handled src/command_line/program.cpp \
    'if (inherited.sa_handler != SIG_IGN)' 'if (false)'
  plant file-size-limit-kills src/command_line/program.cpp '  signal(SIGXFSZ, SIG_IGN);' ''
  plant overwrites-a-texture src/cli/render_job.cpp \
    'std::filesystem::exists(file) && !isOurPicture(file)' 'false'

  testedBy serve_test 'PictureStream.*:Serving*.*'
  plant no-nosniff viewer/serve/server.cpp \
    '{"X-Content-Type-Options", "nosniff"},' '{"X-Content-Type-Options", ""},'
  plant kept-by-caches viewer/serve/server.cpp \
    '{"Cache-Control", "no-store"}' '{"Cache-Control", "max-age=3600"}'
  plant any-http-origin viewer/serve/server.cpp \
    'origin != "http://" + request.get_header_value("Host")' '!origin.starts_with("http://")'
  plant no-bound-of-messages viewer/serve/served_session.cpp \
    'if (messages_.size() + messages.size() > kMostMessages) return false;' ''
  plant acknowledges-one-alone viewer/serve/picture_stream.cpp \
    'underWay_.erase(underWay_.begin(), found + 1);' 'underWay_.erase(found);'
  plant download-name-as-it-is viewer/serve/server.cpp \
    'std::isalnum(static_cast<unsigned char>(c)) ? c : '\''-'\''' 'c'

  testedBy reference_test 'FrostedGlass.ShowsWhatItsSurfaceTransmits'
  plant frosted-transmission-too-strong src/reference/add_impulses.cpp \
    '(passes * s.coverage) * f.transmission,' '(passes * s.coverage * 1.02) * f.transmission,'
  plant frosted-color-too-strong src/reference/add_impulses.cpp \
    '* surfel.transmission, mirror);
    frosting.mediaBehind' \
    '* 1.02 * surfel.transmission, mirror);
    frosting.mediaBehind'

  testedBy reference_test 'Projections.*'
  plant camera-without-skew src/scene/camera.cpp 'double{camera.k[4]} * scaleX * stepY' '0'
  plant image-center-half-a-pixel-off src/scene/camera.cpp \
    '(double{camera.k[2]} + 0.5) * scaleX' 'double{camera.k[2]} * scaleX'

  testedBy example_test 'Library.*:RayQueries.*'
  plant rays-count-written-instances src/library/rays.cpp \
    'scene.instances[instance].written' 'instance'
  plant rays-side-swapped src/library/rays.cpp 'hit.back ? -1 : 1' 'hit.back ? 1 : -1'
  plant left-of-crop-lost src/library/image.cpp 'return data_->film.image.window.x0;' 'return 0;'
  plant bytes-without-alpha src/library/image.cpp 'all.at("hasAlpha").get<bool>()' 'false'

  testedBy accuracy_test 'SceneDigest.*'
  plant fog-not-in-digest src/output/digest.cpp '!isBlack(fog.density)' 'false'

  testedBy viewer_test 'Viewer.AScenePaused*'
  plant command-time-rounded viewer/session/view_files.cpp '" --time %.17g"' '" --time %.3g"'

  testedBy io_test 'GltfMotion.*:Mtl.*:Ply.*:ScenePaths.*'
  plant length-of-last-sampler src/io/gltf/nodes.cpp \
    'last = std::max(last, lastTime(document, sampler.need("input")));' \
    'last = lastTime(document, sampler.need("input"));'
  plant mtl-glass-of-vacuum src/io/obj/mtl_reader.cpp 'numberOr("ni", m.ior)' 'numberOr("ni", 1)'
  plant ply-picture-behind-the-last src/io/ply/ply_model.cpp \
    'face.picture < static_cast<double>(pictures.size())' \
    'face.picture <= static_cast<double>(pictures.size())'
  plant warning-swaps-files src/io/files.cpp \
    'fallback.string() + " for " + excerpt(text)' 'excerpt(text) + " for " + fallback.string()'
  plant shipped-before-variable src/io/files.cpp \
    'for (const fs::path& folder : folders) {
    fs::path candidate' 'for (const fs::path& folder : std::vector(folders.rbegin(), folders.rend())) {
    fs::path candidate'

  testedBy images_test 'ReadTga.*'
  plant tga-palette-of-15-bits src/io/image/plain_formats.cpp '(entryBits + 7) / 8' 'entryBits / 8'

  testedBy cli_test 'DeadEnds.*:BudgetCommands.*:TurntableCommand.*:Images.*:Explain.*:AbEffects.*'
  plant serve-ignores-camera viewer/serve/serve_command.cpp \
    'common.given.contains("camera") || common.ground' 'common.ground'
  plant receipt-loses-a-word src/cli/render.cpp \
    "isValue = isLeftOut && word.find('=') == std::string::npos;" 'isValue = isLeftOut;'
  plant turntable-ignores-up src/cli/render.cpp 'camera.up = options.up.value_or(camera.up);' ''
  plant jpeg-by-one-name src/output/image_output.cpp \
    'extensionOf(path) == ".jpg" || extensionOf(path) == ".jpeg"' 'extensionOf(path) == ".jpg"'
  plant left-out-rays-twice src/cli/explain.cpp \
    'restAdds_ += contributionOf(e_.rays.packets, number, n.local)' \
    'restAdds_ += contributionOf(e_.rays.packets, number, n.radiance)'
  plant auto-over-all src/cli/bench.cpp 'ratioOf(runs[i + 1], runs[i])' 'ratioOf(runs[i], runs[i + 1])'

  testedBy example_test 'Library.*'
  plant exposure-of-the-other-camera src/engine/engine.cpp \
    'optionsChanged_ |= camera || lookedThrough_;' 'optionsChanged_ |= camera.has_value();'

  testedBy viewer_test 'Sessions.*:Viewer.EachKey*:RecentScenes.*:SavedScenes.Find*'
  plant undo-joins-next-edit viewer/session/history.cpp \
    'sinceEdit_ = kEditPauseSeconds;' ''
  plant q-and-e-swapped viewer/app_keys.cpp 'axis("E", "Q")' 'axis("Q", "E")'
  plant recent-scenes-without-limit viewer/session/view_files.cpp \
    'recent.resize(std::min(recent.size(), kMostRecent));' '(void)kMostRecent;'
  plant parameters-not-saved viewer/session/view_files.cpp \
    'document.root["parameters"][parameter] = value;' '(void)parameter, (void)value;'

  testedBy serve_test 'Serving.SoMany*:Serving.ALarge*'
  plant one-page-too-many viewer/serve/server.cpp 'pages_.size() >= kMostPages' 'pages_.size() > kMostPages'
  plant page-shrunk-twice viewer/serve/served_session.cpp \
    'std::sqrt(std::min(kMostWindowPixels / (width * height), 1.0))' \
    'std::min(kMostWindowPixels / (width * height), 1.0)'
}

mode=run
wanted=()
for word in "$@"; do
  case $word in
    --list | --check) mode=${word#--} ;;
    -*) echo "tests/mutate.sh: unknown option '$word' (--list, --check)" >&2; exit 2 ;;
    *) wanted+=("$word") ;;
  esac
done
if [ "$mode" = run ]; then
  mkdir -p "$copy"
  # What has gone since the last run would be built again.
  (cd "$copy" && find src simd scenes viewer tests -type f 2>/dev/null) | while read -r file; do
    [ -e "$root/$file" ] || rm "$copy/$file"
  done
  (cd "$root" && cp -ru CMakeLists.txt src simd scenes viewer tests "$copy/") || exit 1
  # shellcheck disable=SC2086  # a list of words
  cmake -G Ninja -S "$copy" -B "$copy/build" -DCMAKE_BUILD_TYPE=Release -DWHIT_SIMD_TARGETS=TWO \
    ${WHIT_MUTATE_CMAKE:-} >/dev/null || exit 1
fi
mutations
if [ "${#wanted[@]}" -gt $planted ]; then
  echo "tests/mutate.sh: some of these are not known: ${wanted[*]} (--list)" >&2
  exit 2
fi
if [ "${#survived[@]}" -gt 0 ]; then
  echo "NOT CAUGHT: ${survived[*]}" >&2
  exit 1
fi
if [ "$mode" = check ]; then echo "mutations: $planted places, each found once"; fi
