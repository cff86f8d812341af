/// \file  What libFuzzer calls: the one target that this program is compiled for.

#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return plumb::fuzz::PLUMB_FUZZ_TARGET(data, size);
}
