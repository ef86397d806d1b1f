#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace liloc {

/// A queue between threads that never grows past its capacity: when it is full the oldest item makes room for
/// the newest, and `push` hands the loser back so that its owner can be told. Any thread may call anything.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity == 0 ? 1 : capacity) {}

  /// Never blocks. Returns the item it displaced, or `item` itself once the queue is closed.
  [[nodiscard]] std::optional<T> push(T item) {
    std::optional<T> displaced;
    {
      const std::scoped_lock lock(mutex_);
      if (closed_) return item;
      if (items_.size() >= capacity_) {
        displaced = std::move(items_.front());
        items_.pop_front();
      }
      items_.push_back(std::move(item));
    }
    ready_.notify_one();
    return displaced;
  }

  /// Takes out the first item that `matches`, e.g. an older request of the same client; empty if none does.
  [[nodiscard]] std::optional<T> take_if(const std::function<bool(const T&)>& matches) {
    const std::scoped_lock lock(mutex_);
    for (auto it = items_.begin(); it != items_.end(); ++it)
      if (matches(*it)) {
        std::optional<T> item(std::move(*it));
        items_.erase(it);
        return item;
      }
    return std::nullopt;
  }

  /// Blocks until an item is there. After stop or close it drains what is left, then returns empty.
  [[nodiscard]] std::optional<T> pop(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    ready_.wait(lock, stop, [this] { return closed_ || !items_.empty(); });
    return take_front();
  }

  [[nodiscard]] std::optional<T> try_pop() {
    const std::scoped_lock lock(mutex_);
    return take_front();
  }

  /// Refuses new items from now on and wakes every waiter.
  void close() {
    {
      const std::scoped_lock lock(mutex_);
      closed_ = true;
    }
    ready_.notify_all();
  }

  [[nodiscard]] std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return items_.size();
  }

 private:
  std::optional<T> take_front() {
    if (items_.empty()) return std::nullopt;
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    return item;
  }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable_any ready_;
  std::deque<T> items_;
  bool closed_ = false;
};

}  // namespace liloc
