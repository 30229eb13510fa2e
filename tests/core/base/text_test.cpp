#include "core/base/plain_text.h"
#include "core/base/text.h"

#include <gtest/gtest.h>

namespace lumorph {
namespace {

using namespace std::string_literals;

TEST(InQuotes, ShowsTextAsItIs) {
    EXPECT_EQ(inQuotes(""), "''");
    EXPECT_EQ(inQuotes("sea.png"), "'sea.png'");
    EXPECT_EQ(inQuotes("M\u00f6bel \u6d77 \U0001F30A"), "'M\u00f6bel \u6d77 \U0001F30A'");
}

TEST(InQuotes, ShortensWhatIsLong) {
    EXPECT_EQ(inQuotes("abcdef", 6), "'abcdef'");
    EXPECT_EQ(inQuotes("abcdefg", 6), "'abcdef...'");
    EXPECT_EQ(inQuotes("abcd", 0), "'...'");
    EXPECT_EQ(inQuotes(std::string(1'000'000, 'x')), "'" + std::string(80, 'x') + "...'");
    EXPECT_EQ(inQuotes("ab\u00f6cd", 3), "'ab...'") << "no character is cut in two";
}

TEST(InQuotes, KeepsWhatIsNoTextOutOfMessages) {
    EXPECT_EQ(inQuotes("a\nb\tc\x7f\0d"s), "'a?b?c??d'");
    EXPECT_EQ(inQuotes("\u0085"), "'?'") << "a control character of two bytes";
    EXPECT_EQ(inQuotes("\xff\xfe."), "'??.'");
    EXPECT_EQ(inQuotes("\xc3(\xc3"), "'?(?'") << "characters that break off";
    EXPECT_EQ(inQuotes("\xc0\xaf."), "'??.'") << "longer than need be";
    EXPECT_EQ(inQuotes("\xed\xa0\x80."), "'???.'") << "half of a pair";
    EXPECT_EQ(inQuotes("\xf4\x90\x80\x80."), "'????.'") << "beyond Unicode";
}

std::string inUtf16(std::u16string_view text, bool big, bool mark) {
    std::string bytes;
    const auto put = [&](char16_t unit) {
        const char high = static_cast<char>(unit >> 8U), low = static_cast<char>(unit & 0xFFU);
        bytes += big ? high : low;
        bytes += big ? low : high;
    };
    if (mark) put(u'\uFEFF');
    for (const char16_t unit : text) put(unit);
    return bytes;
}

TEST(PlainText, IsUtf8WithoutItsMark) {
    EXPECT_EQ(PlainText("v 0 0 0\n").view(), "v 0 0 0\n");
    EXPECT_EQ(PlainText("\xEF\xBB\xBFv 0 0 0\n").view(), "v 0 0 0\n");
    EXPECT_EQ(PlainText("").view(), "");
    EXPECT_EQ(PlainText("\xEF\xBB\xBF").view(), "");
    const std::string binary = "a\0b"s + std::string(13, '\0');
    EXPECT_EQ(PlainText(binary).view(), binary) << "zeros that are no half of a character";
}

TEST(PlainText, ConvertsUtf16OfEitherByteOrder) {
    const std::u16string_view text = u"v 1\n# M\u00F6bel \u6D77 \U0001F30A\r\n";
    for (const bool big : {false, true})
        for (const bool mark : {false, true})
            EXPECT_EQ(PlainText(inUtf16(text, big, mark)).view(), "v 1\n# M\u00F6bel \u6D77 \U0001F30A\r\n")
                << big << mark;
    const std::u16string broken = {u'a', u'b', u'c', u'd', char16_t{0xDC00}, u'e', char16_t{0xD800}};
    EXPECT_EQ(PlainText(inUtf16(broken, false, true)).view(), "abcd\uFFFDe\uFFFD") << "halves of pairs";
    EXPECT_EQ(PlainText(inUtf16(u"abcd", false, true) + "e").view(), "abcd\uFFFD") << "half a character at the end";
    EXPECT_TRUE(isUtf8(PlainText(inUtf16(broken, true, true)).view()));
}

TEST(CsvField, IsBareWhereItCanBe) {
    EXPECT_EQ(csvField(""), "");
    EXPECT_EQ(csvField("corner front left"), "corner front left");
    EXPECT_EQ(csvField("it's; 5 %"), "it's; 5 %");
}

TEST(CsvField, IsInQuotesWhereItMustBe) {
    EXPECT_EQ(csvField("a,b"), R"("a,b")");
    EXPECT_EQ(csvField(R"(the "left" one)"), R"("the ""left"" one")");
    EXPECT_EQ(csvField("two\nlines"), "\"two\nlines\"");
    EXPECT_EQ(csvField("two\r\nlines"), "\"two\r\nlines\"");
    EXPECT_EQ(csvField("\""), R"("""")");
}

} // namespace
} // namespace lumorph
