/// \file  Edit distance (optimal string alignment).
#include "renderer/io/nearest_name.h"

#include <algorithm>
#include <vector>

namespace plumb {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, previous(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        previous[j] = j;
    before = previous;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({previous[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = previous;
        previous = row;
    }
    return previous[b.size()];
}

} // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest = 64; // names beyond this are no misspellings
    std::string_view nearest;
    std::size_t smallest = name.size() / 3 + 2;
    if (name.size() > longest)
        return nearest;
    for (const std::string_view candidate : candidates) {
        // The lengths alone give a lower bound, which spares most of a long list.
        const std::size_t longer = std::max(name.size(), candidate.size());
        if (longer - std::min(name.size(), candidate.size()) >= smallest)
            continue;
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < smallest) {
            smallest = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
    const std::string_view nearest = nearest_name(name, candidates);
    return nearest.empty() ? std::string{} : " (did you mean '" + std::string(nearest) + "'?)";
}

std::string did_you_mean(std::string_view name,
                         std::initializer_list<std::string_view> candidates) {
    return did_you_mean(name, std::span(candidates.begin(), candidates.size()));
}

} // namespace plumb
