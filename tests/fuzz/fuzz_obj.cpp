/// \file  Any bytes as an OBJ file.

#include "renderer/io/read_obj.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/mesh_checks.h"

namespace plumb::fuzz {

int fuzz_obj(const std::uint8_t* data, std::size_t size) {
    require_reads_or_refuses(read_obj_text, data, size);
    return 0;
}

} // namespace plumb::fuzz
