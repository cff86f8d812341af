/// \file  The meshes by name: those that are generated, and those of files.
#pragma once

#include "tools/bench_src/bench_mesh.h"

#include <filesystem>
#include <string_view>

namespace plumb::bench {

struct CatalogueEntry {
    std::string_view name;
    std::string_view description;
    BenchMesh (*generate)(double detail);
    double quick_detail; ///< of --quick
};

/// In the order in which they are benchmarked, smallest first.
[[nodiscard]] std::span<const CatalogueEntry> catalogue();

/// A mesh of the catalogue, at full size or the small one of --quick.
[[nodiscard]] BenchMesh generate(const CatalogueEntry& entry, bool quick);

/// An obj or ply file, seen from outside. Throws SceneError for a file that cannot be read or is
/// neither. Warnings of the readers are appended.
[[nodiscard]] BenchMesh load_mesh(const std::filesystem::path& file,
                                  std::vector<std::string>& warnings);

} // namespace plumb::bench
