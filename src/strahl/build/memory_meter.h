// build/memory_meter.h - what a build owns at the moment, held against its limit.
//
// Thread safety: leases of one meter may be taken and returned from any task.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>
#include <utility>

#include <strahl/base/build_context.h>

namespace strahl {

/// Adds up what is leased. Must outlive its leases.
class MemoryMeter {
 public:
  MemoryMeter(const BuildContext& context, std::string_view what)
      : context_(context), what_(what) {}

  /// Throws Error{resource} when the sum would pass the build's limit.
  void take(std::uint64_t bytes) {
    context_.require_memory(bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes, what_);
  }
  /// What is taken at the moment.
  std::uint64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  void give_back(std::uint64_t bytes) { bytes_.fetch_sub(bytes, std::memory_order_relaxed); }

 private:
  const BuildContext& context_;
  std::string_view what_;
  std::atomic<std::uint64_t> bytes_{0};
};

/// Bytes taken from a meter until the end of its life.
class MemoryLease {
 public:
  MemoryLease() = default;
  MemoryLease(MemoryMeter& meter, std::uint64_t bytes) : meter_(&meter), bytes_(bytes) {
    meter.take(bytes);
  }
  MemoryLease(MemoryLease&& o) noexcept
      : meter_(std::exchange(o.meter_, nullptr)), bytes_(o.bytes_) {}
  MemoryLease& operator=(MemoryLease&& o) noexcept {
    std::swap(meter_, o.meter_), std::swap(bytes_, o.bytes_);
    return *this;
  }
  ~MemoryLease() {
    if (meter_ != nullptr) meter_->give_back(bytes_);
  }

 private:
  MemoryMeter* meter_ = nullptr;
  std::uint64_t bytes_ = 0;
};

}  // namespace strahl
