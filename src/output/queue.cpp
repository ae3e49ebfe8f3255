#include "output/queue.hpp"

#include <signal.h>

#include <utility>

namespace grainray {
namespace {

/// While it lives this thread takes no signal, and so neither does a thread that it starts: those that end a program are
/// for the thread that waits for them.
class SignalsElsewhere {
public:
    SignalsElsewhere() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsElsewhere() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsElsewhere(const SignalsElsewhere&) = delete;
    SignalsElsewhere& operator=(const SignalsElsewhere&) = delete;

private:
    sigset_t before_;
};

}  // namespace

OutputQueue::OutputQueue(std::size_t snapshots) : most_snapshots_(snapshots) {
    const SignalsElsewhere quiet;
    thread_ = std::thread([this] { work(); });
}

OutputQueue::~OutputQueue() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void OutputQueue::wait_for_room() {
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return snapshots_ < most_snapshots_ || failure_; });
    }
    check();
}

void OutputQueue::push(Job job) { add({std::move(job), false}); }

void OutputQueue::push_snapshot(Job job) {
    wait_for_room();
    add({std::move(job), true});
}

void OutputQueue::add(Entry entry) {
    check();
    {
        const std::lock_guard lock(mutex_);
        snapshots_ += entry.snapshot;
        waiting_.push_back(std::move(entry));
    }
    changed_.notify_all();
}

void OutputQueue::check() {
    std::unique_lock lock(mutex_);
    if (const std::exception_ptr failure = failure_) {
        lock.unlock();
        std::rethrow_exception(failure);
    }
}

void OutputQueue::wait() noexcept {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return (waiting_.empty() && !busy_) || failure_; });
}

void OutputQueue::finish() {
    wait();
    check();
}

void OutputQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        Entry entry = std::move(waiting_.front());
        waiting_.pop_front();
        if (failure_) continue;
        busy_ = true;
        lock.unlock();
        const std::exception_ptr failure = perform(entry);
        lock.lock();
        busy_ = false;
        snapshots_ -= entry.snapshot;
        failure_ = failure;
        changed_.notify_all();
    }
}

/// The snapshot goes with the job, before there may be another one.
std::exception_ptr OutputQueue::perform(Entry& entry) const {
    try {
        const Job job = std::exchange(entry.job, nullptr);
        job();
    } catch (...) {
        return std::current_exception();
    }
    return nullptr;
}

}  // namespace grainray
