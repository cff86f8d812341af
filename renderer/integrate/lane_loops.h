/// \file  The steps of a path that are loops over lanes: the compiler makes vector instructions of
/// them.
///
/// The arithmetic is that of path_steps.h and what it includes; these only call it lane by lane. n:
/// the lanes that count; up to the next multiple of 16 more are computed and mean nothing.
#pragma once

#include "renderer/integrate/path_lanes.h"
#include "renderer/integrate/pixel.h"

namespace plumb {

/// Numbers of one group for every path.
void draw_numbers(const PathLanes& lanes, const SamplerSettings& sampler, std::uint32_t group,
                  std::size_t n, SampleLanes& numbers);

/// Directions (next_direction, wo) and weights of camera rays, from direction_u.
void aim_camera(PathLanes& lanes, const RenderJob& job, std::size_t n);

/// Vertices where `corner`, u and v say, seen from wo. Slivers: `exception` is set, and the vertex
/// is of no use.
void interact_flat(PathLanes& lanes, std::size_t n);

/// A sample of a rectangle light, the only light of the scene, to `shadow` and `light`; `flag`:
/// whether it counts. Where float does not suffice `exception` is set, and the sample is of no use.
void sample_rectangle(PathLanes& lanes, const Light& light, const PathSettings& settings,
                      std::size_t n);

/// New directions from numbers `first` and first + 1 of direction_u, with throughput and pdf;
/// `flag`: whether the path lives. `shading`: normals.
void scatter_lanes(PathLanes& lanes, const Vec3Lanes& shading, HemisphereSampling hemisphere,
                   std::uint32_t first, std::size_t n);

} // namespace plumb
