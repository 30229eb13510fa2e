#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace lumorph::test {

/// A stream gives the same messages wherever it is cut into three parts. `makeParser` makes a fresh one.
template <typename Message, typename MakeParser>
void expectTheSameHoweverCut(std::span<const std::uint8_t> all, const std::vector<Message>& meant,
                             MakeParser makeParser) {
    for (std::size_t a = 0; a <= all.size(); ++a)
        for (std::size_t b = a; b <= all.size(); ++b) {
            auto parser = makeParser();
            std::vector<Message> messages;
            for (const auto& part : std::array{all.first(a), all.subspan(a, b - a), all.subspan(b)})
                for (Message& message : parser.feed(part)) messages.push_back(std::move(message));
            ASSERT_EQ(messages, meant) << a << " " << b;
            ASSERT_EQ(parser.broken(), 0U);
        }
}

} // namespace lumorph::test
