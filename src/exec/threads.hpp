// The CPU threads a simulation may use.
#pragma once

#include <tbb/task_arena.h>

namespace grainray {

class Threads {
public:
    /// 0: all that the machine gives.
    explicit Threads(int count) : arena_(count > 0 ? count : tbb::task_arena::automatic) { arena_.initialize(); }
    int count() const { return arena_.max_concurrency(); }
    template <class F>
    auto run(F&& f) const { return arena_.execute(std::forward<F>(f)); }

private:
    mutable tbb::task_arena arena_;
};

}  // namespace grainray
