/// \file  Which instruction set this processor has.
#include "accel/sah/isa/kernels.h"

#include <stdexcept>
#include <string>

namespace plumb {
namespace {

#ifdef __x86_64__
#ifdef __clang__
// Clang 14 knows no levels, so what they are known by.
bool has_level_3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}
bool has_level_4() {
    return has_level_3() && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#else
bool has_level_3() { return __builtin_cpu_supports("x86-64-v3") != 0; }
bool has_level_4() { return __builtin_cpu_supports("x86-64-v4") != 0; }
#endif
#endif

bool processor_has(Isa isa) {
#ifdef __x86_64__
    if (isa == Isa::avx512)
        return has_level_4();
    if (isa == Isa::avx2)
        return has_level_3();
#endif
    return isa == Isa::portable;
}

} // namespace

Isa usable_isa(Isa wanted) {
    if (wanted == Isa::automatic)
        return processor_has(Isa::avx512) ? Isa::avx512
               : processor_has(Isa::avx2) ? Isa::avx2
                                          : Isa::portable;
    if (!processor_has(wanted))
        throw std::runtime_error("sah: this processor has no " + std::string(name_of(wanted)));
    return wanted;
}

WideKernels kernels_for(Isa usable, TriangleTest test) {
#ifdef __x86_64__
    if (usable == Isa::avx512)
        return avx512_kernels(test);
    if (usable == Isa::avx2)
        return avx2_kernels(test);
#endif
    (void)usable;
    return portable_kernels(test);
}

} // namespace plumb
