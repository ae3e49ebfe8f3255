// Output on a thread of its own, so that the simulation goes on while files are written.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace grainray {

/// Does jobs one after the other, in the order they came. Once a job has thrown none is done any more: a checkpoint stands
/// for everything before it. One thread, the same all the time, calls the functions of a queue.
class OutputQueue {
public:
    using Job = std::function<void()>;

    /// snapshots: how many jobs that hold a copy of the particles there may be, the one under way included. Others are
    /// small and not counted.
    explicit OutputQueue(std::size_t snapshots = 2);
    /// Does what is left; what fails then is lost, so call finish() before.
    ~OutputQueue();
    OutputQueue(const OutputQueue&) = delete;
    OutputQueue& operator=(const OutputQueue&) = delete;

    /// Waits until there may be one more snapshot: to be called before the copy is made. Throws as check().
    void wait_for_room();
    void push(Job);
    void push_snapshot(Job);
    /// Throws what a job has thrown, every time.
    void check();
    /// Waits until every job is done, or one has thrown.
    void wait() noexcept;
    /// wait(), then check().
    void finish();

private:
    struct Entry {
        Job job;
        bool snapshot;
    };
    void add(Entry);
    void work();
    std::exception_ptr perform(Entry&) const;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Entry> waiting_;
    std::size_t most_snapshots_, snapshots_ = 0;
    bool busy_ = false, closing_ = false;
    std::exception_ptr failure_;
    std::thread thread_;  // last: it uses the others
};

}  // namespace grainray
