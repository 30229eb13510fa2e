#include "core/voxels/bit_columns.h"

#include <algorithm>
#include <bit>

namespace lumorph {

// Counting bits is what matching spends its time on; the clone uses the POPCNT instruction where the
// processor has it, which the x86-64 baseline does not promise. Which clone runs is chosen before
// ThreadSanitizer has started, which crashes it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define LUMORPH_COUNTING __attribute__((target_clones("popcnt", "default")))
#else
#define LUMORPH_COUNTING
#endif

BitColumns::BitColumns(glm::ivec3 dimensions)
    : dimensions_(dimensions), wordsPerColumn_((dimensions.y + 63) / 64),
      words_(columnCount() * static_cast<std::size_t>(wordsPerColumn_)) {}

void BitColumns::clear() noexcept { std::fill(words_.begin(), words_.end(), 0); }

namespace {

LUMORPH_COUNTING std::size_t countWords(const std::uint64_t* words, std::size_t size) noexcept {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += static_cast<std::size_t>(__builtin_popcountll(words[i]));
    return sum;
}

LUMORPH_COUNTING std::size_t countWordsAnd(const std::uint64_t* a, const std::uint64_t* b, std::size_t size) noexcept {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += static_cast<std::size_t>(__builtin_popcountll(a[i] & b[i]));
    return sum;
}

} // namespace

std::size_t countBits(std::span<const std::uint64_t> words) noexcept { return countWords(words.data(), words.size()); }

std::size_t countBitsAnd(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) noexcept {
    return countWordsAnd(a.data(), b.data(), a.size());
}

std::size_t BitColumns::count() const noexcept { return countBits(words_); }

std::size_t BitColumns::countAnd(const BitColumns& other) const noexcept { return countBitsAnd(words_, other.words_); }

BitColumns& BitColumns::operator|=(const BitColumns& other) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
}

BitColumns& BitColumns::operator&=(const BitColumns& other) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
}

BitColumns& BitColumns::operator-=(const BitColumns& other) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
    return *this;
}

double intersectionOverUnion(const BitColumns& a, const BitColumns& b) noexcept {
    const std::size_t both = a.countAnd(b);
    const std::size_t either = a.count() + b.count() - both;
    return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

} // namespace lumorph
