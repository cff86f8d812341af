/// \file  A stress axis: what is made worse step by step, and the methods that have to bear it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace plumb::stability {

/// One way to do what the axis tests.
struct Method {
    std::string name;
    std::string what;                 ///< a line of text
    bool is_default = false;          ///< the renderer does it this way unless told otherwise
    std::optional<double> limit = {}; ///< largest rate or value that is accepted within the range;
                                      ///< methods without one are never judged
    double from = -std::numeric_limits<double>::infinity(); ///< range of stress of that limit
    double to = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool judged_at(double stress) const {
        return limit && stress >= from && stress <= to;
    }
};

/// What happened to one method at one stress.
struct Outcome {
    std::uint64_t trials = 0;
    std::uint64_t failures = 0;  ///< of axes that count
    std::optional<double> value; ///< of axes that measure; NaN and infinity are kept as they are
};

/// What is asked of an axis.
struct Trial {
    double stress;
    std::size_t count;  ///< about how many trials; an axis may need a fixed number
    std::uint64_t seed; ///< the outcome is a pure function of these three
};

struct Axis {
    std::string name;  ///< as --axes takes it
    std::string group; ///< methods of one group are rows of one table
    std::string title;
    std::string unit;             ///< of the stress
    std::string tested;           ///< what a trial is
    std::string failure;          ///< when it has failed, or what the value is
    std::string range;            ///< over which range the default has which limit, in words
    std::string value;            ///< name of the value; empty: failures are counted
    std::vector<double> stresses; ///< ascending
    std::size_t trials = 0, quick_trials = 0;
    double quick_to = std::numeric_limits<double>::infinity(); ///< largest stress of --quick
    std::vector<Method> methods;
    /// One outcome for each method, all over the same trials.
    std::function<std::vector<Outcome>(const Trial&)> run;

    [[nodiscard]] bool counts() const { return value.empty(); }
    /// The rate or the value; a value that is no number counts as infinite.
    [[nodiscard]] double badness(const Outcome& outcome) const;
    /// Whether a method that is judged at this stress does not hold its limit.
    [[nodiscard]] bool violated(std::size_t method, double stress, const Outcome& outcome) const;
};

/// Every axis, in the order of the map.
[[nodiscard]] std::vector<Axis> all_axes();

// Those of each file, in order.
void add_triangle_axes(std::vector<Axis>& axes);
void add_slab_axes(std::vector<Axis>& axes);
void add_sphere_axes(std::vector<Axis>& axes);
void add_ray_offset_axes(std::vector<Axis>& axes);
void add_light_axes(std::vector<Axis>& axes);
void add_roulette_axis(std::vector<Axis>& axes);
void add_direction_axes(std::vector<Axis>& axes);
void add_sum_axes(std::vector<Axis>& axes);
void add_tree_axes(std::vector<Axis>& axes);

} // namespace plumb::stability
