#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lumorph {

/// A list that is emptied and filled again and again; its elements keep their memory meanwhile.
template <typename T> class Reused {
public:
    void clear() noexcept { size_ = 0; }
    /// One more at the end, with whatever it held before.
    T& next() {
        if (size_ == items_.size()) items_.emplace_back();
        return items_[size_++];
    }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] const T& operator[](std::size_t i) const { return items_[i]; }
    [[nodiscard]] auto begin() const { return items_.begin(); }
    [[nodiscard]] auto end() const { return items_.begin() + static_cast<std::ptrdiff_t>(size_); }
    bool operator==(const Reused& other) const { return std::equal(begin(), end(), other.begin(), other.end()); }

private:
    std::vector<T> items_;
    std::size_t size_ = 0;
};

} // namespace lumorph
