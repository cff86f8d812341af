/// \file  A parallel loop over independent items.
#pragma once

#include <cstddef>
#include <functional>

namespace plumb {

/// Runs body(i) for i in [0, count), each once, on up to `threads` threads (0: all cores). Returns
/// when all are done; the first exception of a body is rethrown. The build chooses the backend:
/// TBB, or std::thread for ThreadSanitizer, which does not understand the packaged TBB.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// Threads that `threads` stands for: itself, or the machine's cores for 0.
[[nodiscard]] int thread_count(int threads);

} // namespace plumb
