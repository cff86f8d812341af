#include "tools/stability_src/sweep.h"

#include "accel/parallel/parallel.h"

#include <mutex>
#include <string_view>

namespace plumb::stability {
namespace {

/// S. Vigna's SplitMix64.
std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30u)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27u)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31u);
}

/// Of one step: it does not depend on which other axes run.
std::uint64_t step_seed(std::uint64_t seed, std::string_view axis, std::size_t stress) {
    std::uint64_t hash = mix(seed);
    for (const char c : axis)
        hash = mix(hash ^ static_cast<unsigned char>(c));
    return mix(hash ^ stress);
}

} // namespace

std::vector<AxisResult> sweep(std::span<const Axis> axes, const SweepOptions& options,
                              const OnStep& on_step) {
    struct Step {
        std::size_t axis, stress;
    };
    std::vector<AxisResult> results;
    std::vector<Step> steps;
    for (const Axis& axis : axes) {
        AxisResult& result = results.emplace_back(AxisResult{axis, {}});
        if (options.quick)
            std::erase_if(result.axis.stresses, [&](double s) { return s > axis.quick_to; });
        result.outcomes.resize(result.axis.stresses.size());
        for (std::size_t i = 0; i < result.axis.stresses.size(); ++i)
            steps.push_back({results.size() - 1, i});
    }
    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(steps.size(), options.threads, [&](std::size_t i) {
        AxisResult& result = results[steps[i].axis];
        const Axis& axis = result.axis;
        result.outcomes[steps[i].stress] = axis.run(
            {axis.stresses[steps[i].stress], options.quick ? axis.quick_trials : axis.trials,
             step_seed(options.seed, axis.name, steps[i].stress)});
        const std::lock_guard lock(mutex);
        ++done;
        if (on_step)
            on_step(done, steps.size(), axis);
    });
    return results;
}

std::vector<Violation> violations(const AxisResult& result) {
    const Axis& axis = result.axis;
    std::vector<Violation> found;
    for (std::size_t m = 0; m < axis.methods.size(); ++m) {
        std::optional<std::size_t> worst;
        for (std::size_t s = 0; s < axis.stresses.size(); ++s) {
            const Outcome& outcome = result.outcomes[s][m];
            if (axis.violated(m, axis.stresses[s], outcome) &&
                (!worst || axis.badness(outcome) > axis.badness(result.outcomes[*worst][m])))
                worst = s;
        }
        if (worst)
            found.push_back({m, *worst});
    }
    return found;
}

} // namespace plumb::stability
