/// \file  The functions that libFuzzer calls with bytes of its own and the replay with the corpus.
///
/// Each gives 0 and throws Finding, or ends the process, for what must not be. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>

namespace plumb::fuzz {

/// A scene file: refused with file, line and column, or loaded, traced and without a NaN.
int fuzz_scene_xml(const std::uint8_t* data, std::size_t size);
/// A Wavefront OBJ file: a sound mesh or a refusal.
int fuzz_obj(const std::uint8_t* data, std::size_t size);
/// A PLY file: a sound mesh or a refusal.
int fuzz_ply(const std::uint8_t* data, std::size_t size);
/// Arguments, one a line: options within their ranges, or one line that says why not.
int fuzz_command_line(const std::uint8_t* data, std::size_t size);
/// Triangles, spheres and rays: every Intersector against each other and against brute force.
int fuzz_intersectors(const std::uint8_t* data, std::size_t size);

} // namespace plumb::fuzz
