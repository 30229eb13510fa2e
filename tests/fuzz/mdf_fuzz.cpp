#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include <xxhash.h>

#include "core/base/error.h"
#include "core/mdf/field_file.h"
#include "core/mdf/voting.h"

namespace {

constexpr std::size_t kFileHeader = 24;
constexpr std::size_t kBlockHeader = 32;

/// Puts the right checksum into every block, so that mutations reach what lies behind it.
void mendChecksums(std::vector<std::byte>& file) {
    for (std::size_t at = kFileHeader; at + kBlockHeader <= file.size();) {
        std::uint64_t stored = 0;
        std::memcpy(&stored, &file[at + 16], sizeof stored);
        if (stored > file.size() - at - kBlockHeader) return;
        const std::uint64_t sum = XXH64(file.data() + at + kBlockHeader, stored, 0);
        std::memcpy(&file[at + 24], &sum, sizeof sum);
        at += kBlockHeader + stored;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    const auto bytes = std::as_bytes(std::span(data, size));
    std::vector<std::byte> file(bytes.begin(), bytes.end());
    mendChecksums(file);
    try {
        const Field field = parseField(file, "fuzz.mdf");
        if (field.frame.voxelCount() > 1'000'000) return 0; // valid but slow
        // Whatever was accepted must be safe to match with and to write again.
        BitColumns all(field.frame.dimensions);
        for (std::uint64_t& word : all.words()) word = ~std::uint64_t{0};
        const Votes votes = Voting(field).match(all);
        for (const ActuatorVote& vote : votes.actuators)
            if (vote.level.index < 0 || vote.level.index >= field.levels) std::abort();
        if (!(parseField(writeField(field), "again.mdf") == field)) std::abort();
    } catch (const Error&) {
        // A refusal is what a broken file is meant to get.
    }
    return 0;
}
