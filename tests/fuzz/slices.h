#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <vector>

namespace lumorph::fuzz {

/// Stops where a parser understands a stream in another way when it comes in slices; the first byte tells how long
/// they are.
template <typename Parser> void expectSameInSlices(const Parser& fresh, std::span<const std::uint8_t> data) {
    if (data.empty()) return;
    const std::size_t slice = data[0] % 16 + 1;
    data = data.subspan(1);
    Parser whole = fresh;
    Parser sliced = fresh;
    const auto meant = whole.feed(data);
    auto got = sliced.feed({});
    for (std::size_t at = 0; at < data.size(); at += slice) {
        auto more = sliced.feed(data.subspan(at, std::min(slice, data.size() - at)));
        std::move(more.begin(), more.end(), std::back_inserter(got));
    }
    if (!(got == meant) || sliced.broken() != whole.broken()) std::abort();
}

} // namespace lumorph::fuzz
