/// \file  The parallel loop: every item once, on any number of threads, exceptions included.

#include "renderer/integrate/parallel_for.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace plumb::test {
namespace {

class ParallelForThreads : public ::testing::TestWithParam<int> {};

TEST_P(ParallelForThreads, RunEveryItemOnce) {
    for (const std::size_t count : {0u, 1u, 2u, 7u, 1000u, 65537u}) {
        std::vector<std::atomic<int>> runs(count);
        parallel_for(count, GetParam(), [&](std::size_t i) { ++runs.at(i); });
        EXPECT_TRUE(std::all_of(runs.begin(), runs.end(), [](const auto& n) { return n == 1; }))
            << count;
    }
}

/// No more bodies at once than threads asked for.
TEST_P(ParallelForThreads, AreNotExceeded) {
    std::atomic<int> now{0}, most{0};
    parallel_for(200, GetParam(), [&](std::size_t) {
        const int mine = ++now;
        int seen = most;
        while (mine > seen && !most.compare_exchange_weak(seen, mine)) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(50));
        --now;
    });
    EXPECT_LE(most, GetParam());
    EXPECT_GE(most, 1);
}

TEST_P(ParallelForThreads, RethrowTheExceptionOfABody) {
    try {
        parallel_for(1000, GetParam(), [](std::size_t i) {
            if (i == 500)
                throw std::runtime_error("item 500");
        });
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
        EXPECT_EQ(std::string(e.what()), "item 500");
    }
}

TEST_P(ParallelForThreads, SurviveAnExceptionInEveryBody) {
    for (int again = 0; again < 20; ++again)
        EXPECT_THROW(parallel_for(100, GetParam(), [](std::size_t) { throw 1; }), int);
    std::atomic<int> runs{0};
    parallel_for(10, GetParam(), [&](std::size_t) { ++runs; }); // and the next loop works
    EXPECT_EQ(runs, 10);
}

INSTANTIATE_TEST_SUITE_P(OneToEight, ParallelForThreads, ::testing::Values(1, 2, 3, 4, 8));

/// What is written by the bodies is seen by the caller: each result by its own index.
TEST(ParallelFor, ResultsDoNotDependOnTheNumberOfThreads) {
    const auto squares = [](int threads) {
        std::vector<std::size_t> result(5000);
        parallel_for(result.size(), threads, [&](std::size_t i) { result[i] = i * i; });
        return result;
    };
    const std::vector<std::size_t> one = squares(1);
    for (const int threads : {0, 2, 3, 4, 8})
        EXPECT_EQ(squares(threads), one) << threads;
}

TEST(ThreadCount, IsTheNumberAskedForOrAllCores) {
    EXPECT_EQ(thread_count(1), 1);
    EXPECT_EQ(thread_count(5), 5);
    EXPECT_EQ(thread_count(0), std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

} // namespace
} // namespace plumb::test
