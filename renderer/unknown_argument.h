/// \file  The message about an argument that no option takes.
#pragma once

#include "renderer/io/nearest_name.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// `unknown option '--X'` with the nearest option of the program, or `unexpected argument 'X'`; for
/// the first of the arguments that `app` left over.
[[nodiscard]] inline std::string unknown_argument(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    const std::vector<std::string_view> views(names.begin(), names.end());
    for (const std::string& argument : app.remaining(true))
        if (argument.starts_with("-"))
            return fmt::format("unknown option '{}'{}", argument,
                               did_you_mean(argument.substr(0, argument.find('=')), views));
    const auto rest = app.remaining(true);
    return fmt::format("unexpected argument '{}'", rest.empty() ? "" : rest.front());
}

} // namespace plumb
