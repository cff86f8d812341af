#include "tools/stability_src/report.h"

#include "tools/stability_src/interval.h"

#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace plumb::stability {
namespace {

/// A JSON string.
std::string text(std::string_view s) {
    std::string out = "\"";
    for (const char c : s) {
        if (c == '"' || c == '\\')
            out += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + "\"";
}

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

std::string_view boolean(bool value) { return value ? "true" : "false"; }

std::string method_json(const Method& m) {
    std::string out = fmt::format("{{\"name\": {}, \"what\": {}, \"default\": {}", text(m.name),
                                  text(m.what), boolean(m.is_default));
    if (m.limit)
        out += fmt::format(", \"limit\": {}, \"from\": {}, \"to\": {}", number(*m.limit),
                           number(m.from), number(m.to));
    return out + "}";
}

template <class Range, class F>
std::string list(const Range& range, F&& element, std::string_view separator = ", ") {
    std::string out;
    for (const auto& item : range) {
        if (!out.empty())
            out += separator;
        out += element(item);
    }
    return out;
}

std::string axis_json(const AxisResult& result) {
    const Axis& a = result.axis;
    return fmt::format("    {{\"name\": {}, \"group\": {}, \"title\": {}, \"unit\": {},\n"
                       "     \"tested\": {},\n     \"failure\": {},\n     \"range\": {},\n"
                       "     \"value\": {}, \"stresses\": [{}],\n     \"methods\": [\n       {}]}}",
                       text(a.name), text(a.group), text(a.title), text(a.unit), text(a.tested),
                       text(a.failure), text(a.range), a.counts() ? "null" : text(a.value),
                       list(a.stresses, number), list(a.methods, method_json, ",\n       "));
}

std::string cell_json(const Axis& axis, std::size_t method, double stress, const Outcome& o) {
    const Method& m = axis.methods[method];
    std::string out = fmt::format(
        "    {{\"axis\": {}, \"stress\": {}, \"method\": {}, \"group\": {}, \"default\": {}, "
        "\"trials\": {}",
        text(axis.name), number(stress), text(m.name), text(axis.group), boolean(m.is_default),
        o.trials);
    if (axis.counts()) {
        const RateInterval interval = wilson_interval(o.failures, o.trials);
        out +=
            fmt::format(", \"failures\": {}, \"rate\": {}, \"low\": {}, \"high\": {}", o.failures,
                        number(axis.badness(o)), number(interval.low), number(interval.high));
    } else {
        out += fmt::format(", \"value\": {}", number(axis.badness(o)));
    }
    if (m.judged_at(stress))
        out += fmt::format(", \"limit\": {}, \"ok\": {}", number(*m.limit),
                           boolean(!axis.violated(method, stress, o)));
    return out + "}";
}

/// A rate or value for people.
std::string shown(const Axis& axis, double badness) {
    if (!std::isfinite(badness))
        return "infinite";
    if (!axis.counts())
        return fmt::format("{:.3g}", badness);
    return badness == 0 ? "0" : fmt::format("{:.3g} %", 100 * badness);
}

/// The worst of all stresses that `counts` accepts, or nothing.
template <class F>
std::optional<double> worst_of(const AxisResult& r, std::size_t method, F&& counts) {
    std::optional<double> worst;
    for (std::size_t s = 0; s < r.axis.stresses.size(); ++s)
        if (counts(r.axis.stresses[s])) {
            const double badness = r.axis.badness(r.outcomes[s][method]);
            worst = worst ? std::max(*worst, badness) : badness;
        }
    return worst;
}

std::string axis_line(const AxisResult& r) {
    const Axis& axis = r.axis;
    double own = 0, limit = 0, other = -1;
    std::string other_name = "-";
    for (std::size_t m = 0; m < axis.methods.size(); ++m) {
        const Method& method = axis.methods[m];
        if (method.is_default) {
            own = std::max(
                own, worst_of(r, m, [&](double s) { return method.judged_at(s); }).value_or(0));
            limit = method.limit.value_or(0);
        } else if (const double w = worst_of(r, m, [](double) { return true; }).value_or(0);
                   w > other) {
            other = w;
            other_name = method.name;
        }
    }
    return fmt::format("{:<16} {:>10} {:>9}  {:>9}  {}\n", axis.name, shown(axis, own),
                       shown(axis, limit), shown(axis, other), other_name);
}

} // namespace

std::string to_json(const RunInfo& info, std::span<const AxisResult> results) {
    std::string cells;
    for (const AxisResult& r : results)
        for (std::size_t s = 0; s < r.axis.stresses.size(); ++s)
            for (std::size_t m = 0; m < r.axis.methods.size(); ++m)
                cells += (cells.empty() ? "" : ",\n") +
                         cell_json(r.axis, m, r.axis.stresses[s], r.outcomes[s][m]);
    return fmt::format(
        "{{\n  \"version\": {},\n  \"command_line\": {},\n  \"cpu\": {},\n  \"embree\": {},\n"
        "  \"compiler\": {},\n  \"quick\": {},\n  \"seed\": {},\n  \"axes\": [\n{}],\n"
        "  \"cells\": [\n{}]\n}}\n",
        text(PLUMB_VERSION), text(info.command_line), text(info.cpu), text(info.embree),
        text(info.compiler), boolean(info.options.quick), info.options.seed,
        list(results, axis_json, ",\n"), cells);
}

std::string table_text(std::span<const AxisResult> results) {
    std::string out = fmt::format("{:<16} {:>10} {:>9}  {:>9}  {}\n", "axis", "default", "limit",
                                  "worst", "of another method");
    for (const AxisResult& r : results)
        out += axis_line(r);
    return out;
}

std::string violations_text(std::span<const AxisResult> results) {
    std::string out;
    for (const AxisResult& r : results)
        for (const Violation& v : violations(r)) {
            const Outcome& o = r.outcomes[v.stress][v.method];
            const Method& m = r.axis.methods[v.method];
            const std::string got = r.axis.counts()
                                        ? fmt::format("{} of {} fail", o.failures, o.trials)
                                        : shown(r.axis, r.axis.badness(o));
            out += fmt::format("{}: {} at {:g}: {} (limit {})\n", r.axis.name, m.name,
                               r.axis.stresses[v.stress], got, shown(r.axis, *m.limit));
        }
    return out;
}

} // namespace plumb::stability
