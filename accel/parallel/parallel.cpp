#include "accel/parallel/parallel.h"

#include <algorithm>
#include <thread>

#if !defined(PLUMB_PARALLEL_STD) && !__has_include(<tbb/task_arena.h>)
#define PLUMB_PARALLEL_STD
#endif

#ifdef PLUMB_PARALLEL_STD
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#endif

namespace plumb {

int thread_count(int threads) {
    return threads > 0 ? threads
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

#ifdef PLUMB_PARALLEL_STD

/// How many more threads may be started, and the first exception of a group of them.
struct Workers::Backend {
    explicit Backend(int threads) : spare(threads - 1) {}

    std::atomic<int> spare;

    bool take() {
        int now = spare;
        while (now > 0)
            if (spare.compare_exchange_weak(now, now - 1))
                return true;
        return false;
    }
};

namespace {

class FirstFailure {
  public:
    /// Runs the body; false where it threw.
    template <class Body> bool run(Body&& body) {
        try {
            body();
            return true;
        } catch (...) {
            const std::scoped_lock lock(mutex_);
            if (!failure_)
                failure_ = std::current_exception();
            return false;
        }
    }
    void rethrow() const {
        if (failure_)
            std::rethrow_exception(failure_);
    }

  private:
    std::exception_ptr failure_;
    std::mutex mutex_;
};

} // namespace

void Workers::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
    std::atomic<std::size_t> next{0};
    FirstFailure failure;
    const auto work = [&] {
        const bool done = failure.run([&] {
            for (std::size_t i = next++; i < count; i = next++)
                body(i);
        });
        if (!done)
            next = count;
    };
    std::vector<std::thread> others;
    while (backend_ && others.size() + 1 < count && backend_->take())
        others.emplace_back([&] {
            work();
            ++backend_->spare;
        });
    work();
    for (std::thread& other : others)
        other.join();
    failure.rethrow();
}

void Workers::invoke(const std::function<void()>& a, const std::function<void()>& b) const {
    if (!backend_ || !backend_->take()) {
        a();
        b();
        return;
    }
    FirstFailure failure;
    std::thread other([&] {
        failure.run(b);
        ++backend_->spare;
    });
    failure.run(a);
    other.join();
    failure.rethrow();
}

#else

struct Workers::Backend {
    explicit Backend(int threads)
        : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
          arena(threads) {}

    tbb::global_control limit;
    tbb::task_arena arena;
};

void Workers::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
    if (!backend_ || count < 2) {
        for (std::size_t i = 0; i < count; ++i)
            body(i);
        return;
    }
    backend_->arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    body(i);
            },
            tbb::simple_partitioner());
    });
}

void Workers::invoke(const std::function<void()>& a, const std::function<void()>& b) const {
    if (!backend_) {
        a();
        b();
        return;
    }
    backend_->arena.execute([&] { tbb::parallel_invoke(a, b); });
}

#endif

Workers::Workers(int threads)
    : count_(thread_count(threads)),
      backend_(count_ > 1 ? std::make_unique<Backend>(count_) : nullptr) {}

Workers::~Workers() = default;

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
    Workers(threads).for_each(count, body);
}

} // namespace plumb
