/// \file  The one place where the exceptions of a tool become exit codes.
#pragma once

#include "cuda/device_error.h"
#include "renderer/scene/error.h"

#include <exception>
#include <fmt/format.h>
#include <new>

namespace plumb {

/// Runs `run`, which returns an exit code; what it throws becomes a line on stderr and a code.
template <class F> int exit_code_of(F&& run) {
    constexpr int internal_error = 70;
    try {
        return run();
    } catch (const SceneError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    } catch (const DeviceError& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return static_cast<int>(ErrorKind::resources);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "error: out of memory\n");
        return static_cast<int>(ErrorKind::resources);
    } catch (const std::exception& error) {
        fmt::print(stderr, "internal error: {}\n", error.what());
        return internal_error;
    }
}

} // namespace plumb
