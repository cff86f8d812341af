#include "tools/bench_src/cpu.h"

#include <ctime>
#include <fstream>

namespace plumb::bench {

std::string cpu_model() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) {
            const std::size_t text = line.find_first_not_of(" \t", line.find(':') + 1);
            return text == std::string::npos ? "unknown" : line.substr(text);
        }
    return "unknown";
}

std::vector<Isa> supported_isas() {
    std::vector<Isa> isas{Isa::portable};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") != 0)
        isas.push_back(Isa::avx2);
    if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
        __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0)
        isas.push_back(Isa::avx512);
#endif
    return isas;
}

double thread_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace plumb::bench
