/// \file  Parallel loops and two-way recursion: the one wrapper of the threading library.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace plumb {

/// Threads that share the work of nested loops and recursion. One thread runs everything in place
/// and starts nothing. The first exception of a body is rethrown to the caller once all that was
/// started has ended. The build chooses the backend: TBB, or std::thread where there is no TBB or
/// for ThreadSanitizer, which does not understand the packaged TBB.
class Workers {
  public:
    /// Up to `threads` threads, the caller among them; 0: all cores.
    explicit Workers(int threads);
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;
    ~Workers();

    [[nodiscard]] int count() const { return count_; }

    /// Runs body(i) for i in [0, count), each once. Bodies may call for_each and invoke.
    void for_each(std::size_t count, const std::function<void(std::size_t)>& body) const;

    /// Runs both, maybe at the same time. They may call for_each and invoke.
    void invoke(const std::function<void()>& a, const std::function<void()>& b) const;

  private:
    struct Backend;
    int count_;
    std::unique_ptr<Backend> backend_; ///< null with one thread
};

/// Runs body(i) for i in [0, count), each once, on up to `threads` threads (0: all cores). Returns
/// when all are done; the first exception of a body is rethrown.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// Threads that `threads` stands for: itself, or the machine's cores for 0.
[[nodiscard]] int thread_count(int threads);

} // namespace plumb
