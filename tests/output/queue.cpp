// The writing thread: order, bound, failures, nothing lost.
#include "output/queue.hpp"

#include <atomic>
#include <chrono>
#include <future>

#include "common.hpp"

namespace grainray::test {
namespace {

using namespace std::chrono_literals;

TEST(Queue, KeepsTheOrderAndLosesNothing) {
    std::vector<int> done;
    {
        OutputQueue queue;
        for (int i = 0; i < 1000; ++i) {
            const auto job = [&done, i] { done.push_back(i); };
            if (i % 7 == 0) queue.push_snapshot(job);
            else queue.push(job);
        }
    }
    ASSERT_EQ(done.size(), 1000u);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
}

/// Counts how many of its kind there are.
struct Copy {
    explicit Copy(std::atomic<int>& alive) : count(alive) { ++count; }
    ~Copy() { --count; }
    std::atomic<int>& count;
};

TEST(Queue, HoldsNoMoreSnapshotsThanItMay) {
    std::atomic<int> alive = 0, most = 0;
    OutputQueue queue(2);
    for (int i = 0; i < 50; ++i) {
        queue.wait_for_room();
        const auto copy = std::make_shared<const Copy>(alive);
        most = std::max<int>(most, alive);
        queue.push_snapshot([copy] { std::this_thread::sleep_for(1ms); });
    }
    queue.finish();
    EXPECT_EQ(most, 2);
}

TEST(Queue, GoesOnWhileAJobIsDone) {
    std::promise<void> go;
    OutputQueue queue(2);
    queue.push_snapshot([waits = go.get_future().share()] { waits.wait(); });
    queue.push_snapshot([] {});
    for (int i = 0; i < 100; ++i) queue.push([] {});  // small ones do not wait for room
    queue.check();
    go.set_value();
    queue.finish();
}

TEST(Queue, StopsAtTheFirstFailureAndSaysItEveryTime) {
    std::atomic<int> done = 0;
    std::promise<void> go;
    OutputQueue queue(2);
    queue.push([&] { ++done; });
    queue.push_snapshot([waits = go.get_future().share()] {
        waits.wait();
        throw SimulationError("the disk is full");
    });
    queue.push_snapshot([&] { ++done; });
    queue.push([&] { ++done; });
    go.set_value();
    for (int k = 0; k < 2; ++k) EXPECT_EQ(message_of<SimulationError>([&] { queue.finish(); }), "the disk is full");
    EXPECT_EQ(message_of<SimulationError>([&] { queue.check(); }), "the disk is full");
    EXPECT_EQ(message_of<SimulationError>([&] { queue.wait_for_room(); }), "the disk is full");
    EXPECT_EQ(message_of<SimulationError>([&] { queue.push([&] { ++done; }); }), "the disk is full");
    EXPECT_EQ(done, 1);
}

TEST(Queue, FailureEndsTheWaitForRoom) {
    OutputQueue queue(1);
    queue.push_snapshot([] {
        std::this_thread::sleep_for(20ms);
        throw InputError("no");
    });
    EXPECT_EQ(message_of<InputError>([&] { queue.push_snapshot([] {}); }), "no");
}

}  // namespace
}  // namespace grainray::test
