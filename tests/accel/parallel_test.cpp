/// \file  The parallel loop: every item once, on any number of threads, exceptions included.

#include "accel/parallel/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
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

std::uint64_t sum_by_halves(const Workers& workers, std::uint64_t begin, std::uint64_t end) {
    if (end - begin == 1)
        return begin;
    std::uint64_t left = 0, right = 0;
    const std::uint64_t middle = begin + (end - begin) / 2;
    workers.invoke([&] { left = sum_by_halves(workers, begin, middle); },
                   [&] { right = sum_by_halves(workers, middle, end); });
    return left + right;
}

TEST_P(ParallelForThreads, RunBothSidesOfARecursion) {
    EXPECT_EQ(sum_by_halves(Workers(GetParam()), 0, 5000), 5000u * 4999 / 2);
}

TEST_P(ParallelForThreads, RunLoopsInsideLoopsAndRecursion) {
    const Workers workers(GetParam());
    std::vector<std::atomic<int>> runs(2 * 50 * 40);
    const auto half = [&](std::size_t side) {
        workers.for_each(50, [&](std::size_t i) {
            workers.for_each(40, [&](std::size_t j) { ++runs[(side * 50 + i) * 40 + j]; });
        });
    };
    workers.invoke([&] { half(0); }, [&] { half(1); });
    EXPECT_TRUE(std::all_of(runs.begin(), runs.end(), [](const auto& n) { return n == 1; }));
}

TEST_P(ParallelForThreads, RethrowTheExceptionOfEitherSide) {
    const Workers workers(GetParam());
    const auto fine = [] {};
    const auto broken = [] { throw std::runtime_error("side"); };
    EXPECT_THROW(workers.invoke(broken, fine), std::runtime_error);
    EXPECT_THROW(workers.invoke(fine, broken), std::runtime_error);
    EXPECT_EQ(sum_by_halves(workers, 0, 100), 100u * 99 / 2); // and the next works
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

TEST(Workers, OneThreadRunsEverythingInPlaceAndInOrder) {
    const Workers workers(1);
    std::vector<int> order;
    const std::thread::id here = std::this_thread::get_id();
    workers.for_each(3, [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), here);
        order.push_back(static_cast<int>(i));
    });
    workers.invoke([&] { order.push_back(3); }, [&] { order.push_back(4); });
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(ThreadCount, IsTheNumberAskedForOrAllCores) {
    EXPECT_EQ(thread_count(1), 1);
    EXPECT_EQ(thread_count(5), 5);
    EXPECT_EQ(thread_count(0), std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

} // namespace
} // namespace plumb::test
