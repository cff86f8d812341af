/// \file  What is known of the machine.
#pragma once

#include "accel/intersector.h"

#include <string>
#include <vector>

namespace plumb::bench {

/// The processor's name as the system tells it; `unknown` where it does not.
[[nodiscard]] std::string cpu_model();

/// portable, and those of avx2 and avx512 that the processor has: worst first.
[[nodiscard]] std::vector<Isa> supported_isas();

/// CPU seconds of the calling thread: what others do on the machine does not count.
[[nodiscard]] double thread_cpu_s();

} // namespace plumb::bench
