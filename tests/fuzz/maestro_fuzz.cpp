#include <cstddef>
#include <cstdint>

#include "devices/protocol/maestro.h"
#include "tests/fuzz/slices.h"

/// The first bytes are questions until one is 3; what follows are answers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    lumorph::maestro::Replies replies;
    std::size_t at = 0;
    for (; at < size && data[at] % 4 != 3; ++at) {
        if (data[at] % 4 == 0)
            replies.expectPosition(data[at] / 4);
        else
            replies.expectErrors();
    }
    if (replies.open() > lumorph::maestro::Replies::kMostOpen) std::abort();
    lumorph::fuzz::expectSameInSlices(replies, std::span(data, size).subspan(at));
    return 0;
}
