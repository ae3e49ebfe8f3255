// What the output tests share: a folder of their own, sample data, damage, a disk that is full.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "grainray/output.hpp"

namespace grainray::test {

namespace fs = std::filesystem;

/// A test with an empty folder that goes away afterwards.
class OutputTest : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("grainray_output_" + std::to_string(::getpid()));
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path folder;
};

inline std::string slurp(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
inline void spill(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

inline std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// No file of this process may grow beyond `bytes` while this lives: writes fail as on a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        ::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int) = SIG_DFL;
};

/// The message of the Exception that `action` throws; "" where it throws none or another one.
template <class Exception, class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const Exception& error) {
        return error.what();
    } catch (const std::exception& other) {
        ADD_FAILURE() << "another exception: " << other.what();
    }
    return "";
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline Frame sample_frame(std::size_t n) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto f = [&] { return static_cast<float>(normal(random)); };
    Frame frame;
    frame.step = 123456789012;
    frame.time = 0.1 + 0.2;
    for (std::size_t i = 0; i < n; ++i) {
        frame.id.push_back(static_cast<std::uint32_t>(3 * i + 1));
        frame.material.push_back(random() % 3);
        frame.coordination.push_back(random() % 13);
        frame.position.push_back({2e5 + normal(random), -1e-300 * normal(random), normal(random)});
        frame.radius.push_back(std::abs(f()));
        frame.mass.push_back(1e30f * f());
        frame.contact_force.push_back(1e-42f * f());  // subnormal
        frame.velocity.push_back({f(), -0.0f, f()});
        frame.angular_velocity.push_back({f(), f(), f()});
    }
    return frame;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expect_same(const Frame& a, const Frame& b) {
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.time, b.time);
    EXPECT_TRUE(same_bits(a.position, b.position));
    EXPECT_TRUE(same_bits(a.id, b.id));
    EXPECT_TRUE(same_bits(a.material, b.material));
    EXPECT_TRUE(same_bits(a.coordination, b.coordination));
    EXPECT_TRUE(same_bits(a.radius, b.radius));
    EXPECT_TRUE(same_bits(a.mass, b.mass));
    EXPECT_TRUE(same_bits(a.contact_force, b.contact_force));
    EXPECT_TRUE(same_bits(a.velocity, b.velocity));
    EXPECT_TRUE(same_bits(a.angular_velocity, b.angular_velocity));
}

}  // namespace grainray::test
