// The search runs in the default stream. A caller's stream is tied to it on both sides of the search by events.
#include "exec/cuda_error.hpp"
#include "neighbors/backend.hpp"

namespace grainray::cuda {

void order_streams(void* first, void* second) {
    cudaEvent_t reached;
    check(cudaEventCreateWithFlags(&reached, cudaEventDisableTiming), "event");
    const cudaError_t recorded = cudaEventRecord(reached, static_cast<cudaStream_t>(first));
    const cudaError_t waits = cudaStreamWaitEvent(static_cast<cudaStream_t>(second), reached);
    cudaEventDestroy(reached);  // once it is reached
    check(recorded, "use of the stream given");
    check(waits, "use of the stream given");
}

}  // namespace grainray::cuda
