// Where data lives: a device, an owning array on it, and a view that kernels take by value.
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "grainray/core.hpp"

namespace grainray {

enum class Device { cpu, cuda };

constexpr std::string_view name(Device d) { return d == Device::cpu ? "cpu" : "cuda"; }

/// True where this build has CUDA and the driver offers a usable GPU.
bool cuda_available();
/// One sentence: why cuda_available() is what it is ("NVIDIA H200, 140 GiB" or "built without CUDA: ...").
std::string cuda_status();
/// Most bytes that this process has held on the GPU at once.
std::size_t cuda_peak_bytes();
/// Bytes that are free on the GPU now; 0 without one.
std::size_t cuda_free_bytes();

/// A GPU as the driver shows it.
struct Gpu {
    std::string name;
    int major = 0, minor = 0;  ///< compute capability
    std::size_t total_bytes = 0, free_bytes = 0;
    std::string problem;       ///< one sentence; empty where this build can use it
};
/// CUDA's versions are 1000 major + 10 minor; 0: none.
struct CudaReport {
    int runtime_version = 0;     ///< of this build
    int driver_supports = 0;     ///< the newest CUDA that the driver serves
    std::string driver_version;  ///< the driver's own, "580.65.06"; empty where it does not say
    std::vector<Gpu> gpus;
};
/// Asks every GPU, which takes a moment and some memory of each.
CudaReport cuda_report();

namespace detail {
// Defined in src/exec/memory.cpp and memory.cu. allocate throws SimulationError with the size asked for.
void* allocate(Device, std::size_t bytes);
void deallocate(Device, void*) noexcept;
void copy(Device to_device, void* to, Device from_device, const void* from, std::size_t bytes);
void clear(Device, void*, std::size_t bytes);
}  // namespace detail

/// Non-owning pointer and size; trivially copyable, for kernels.
template <class T>
struct View {
    T* data = nullptr;
    std::size_t size = 0;

    GR_HD T& operator[](std::size_t i) const { return data[i]; }
    GR_HD T* begin() const { return data; }
    GR_HD T* end() const { return data + size; }
    GR_HD operator View<const T>() const requires(!std::is_const_v<T>) { return {data, size}; }
};

/// Owning array of trivially copyable T on one device. Grows by doubling and never shrinks.
template <class T>
class Array {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit Array(Device device = Device::cpu, std::size_t size = 0) : device_(device) { resize_discard(size); }
    Array(Device device, const std::vector<T>& host) : device_(device) { assign(host); }
    Array(Array&& o) noexcept { swap(o); }
    Array& operator=(Array&& o) noexcept { swap(o); return *this; }
    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;
    ~Array() { detail::deallocate(device_, data_); }

    void swap(Array& o) noexcept {
        std::swap(device_, o.device_);
        std::swap(data_, o.data_);
        std::swap(size_, o.size_);
        std::swap(capacity_, o.capacity_);
    }

    Device device() const { return device_; }
    std::size_t size() const { return size_; }
    std::size_t bytes() const { return capacity_ * sizeof(T); }
    T* data() { return data_; }
    const T* data() const { return data_; }
    View<T> view() { return {data_, size_}; }
    View<const T> view() const { return {data_, size_}; }

    /// New size; what was stored is lost.
    void resize_discard(std::size_t size) {
        if (size > capacity_) {
            detail::deallocate(device_, data_);
            data_ = nullptr;
            capacity_ = 0;
            data_ = static_cast<T*>(detail::allocate(device_, size * sizeof(T)));
            capacity_ = size;
        }
        size_ = size;
    }
    /// As resize_discard, growing with slack, for arrays whose size drifts from call to call.
    void resize_discard_slack(std::size_t size) {
        if (size > capacity_) resize_discard(size + size / 8);
        size_ = size;
    }
    /// Empty, its memory given back.
    void release() { Array(device_).swap(*this); }
    void clear_bytes() { if (size_) detail::clear(device_, data_, size_ * sizeof(T)); }

    void assign(const std::vector<T>& host) {
        resize_discard(host.size());
        if (size_) detail::copy(device_, data_, Device::cpu, host.data(), size_ * sizeof(T));
    }
    void assign(const Array& other) {
        resize_discard(other.size_);
        if (size_) detail::copy(device_, data_, other.device_, other.data_, size_ * sizeof(T));
    }
    /// Adds at the end; what is stored stays.
    void append(const std::vector<T>& host) {
        if (host.empty()) return;
        Array longer(device_, size_ + host.size());
        if (size_) detail::copy(device_, longer.data_, device_, data_, size_ * sizeof(T));
        detail::copy(device_, longer.data_ + size_, Device::cpu, host.data(), host.size() * sizeof(T));
        swap(longer);
    }
    std::vector<T> to_host() const {
        std::vector<T> host(size_);
        if (size_) detail::copy(Device::cpu, host.data(), device_, data_, size_ * sizeof(T));
        return host;
    }

private:
    Device device_ = Device::cpu;
    T* data_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace grainray
