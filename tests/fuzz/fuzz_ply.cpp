/// \file  Any bytes as an PLY file.

#include "renderer/io/read_ply.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/mesh_checks.h"

namespace plumb::fuzz {

int fuzz_ply(const std::uint8_t* data, std::size_t size) {
    require_reads_or_refuses(read_ply_text, data, size);
    return 0;
}

} // namespace plumb::fuzz
