#include "calibration/decode/capture_folder.h"

#include <algorithm>
#include <cctype>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/file.h"
#include "core/base/image.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostImageBytes = std::size_t{256} << 20;
constexpr int kFewestPixels = 32; // a side

bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The run of digits at the front, without leading zeros.
std::string_view takeNumber(std::string_view& text) {
    const auto end = std::ranges::find_if_not(text, isDigit);
    std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
    text.remove_prefix(digits.size());
    while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
    return digits;
}

/// What OpenCV reads of single pictures.
bool isImageName(const std::filesystem::path& file) {
    static const std::set<std::string, std::less<>> kEndings = {
        ".png", ".jpg", ".jpeg", ".jpe", ".bmp", ".dib", ".tif", ".tiff", ".webp", ".jp2",
        ".pgm", ".ppm", ".pbm",  ".pnm", ".pxm", ".pam", ".sr",  ".ras",  ".hdr",  ".pic"};
    return kEndings.contains(lowerCase(file.extension().string())) && !file.filename().string().starts_with('.');
}

/// What a system or this studio writes beside pictures without being asked.
bool isHousekeeping(const std::filesystem::path& file) {
    static const std::set<std::string, std::less<>> kNames = {"thumbs.db", "desktop.ini", "ehthumbs.db", "__macosx"};
    const std::string name = lowerCase(file.filename().string());
    const std::string ending = lowerCase(file.extension().string());
    return name.starts_with('.') || kNames.contains(name) || ending == ".txt" || ending == ".json";
}

std::vector<std::filesystem::path> entriesOf(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> entries;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        entries.push_back(at->path());
    if (error)
        throw DataError(folder.string(), "cannot be listed (" + error.message() + ")", "give a folder of images");
    std::ranges::sort(entries, isNamedBefore);
    return entries;
}

std::string sizeText(const cv::Mat& image) { return std::to_string(image.cols) + " x " + std::to_string(image.rows); }

} // namespace

bool isNamedBefore(const std::filesystem::path& one, const std::filesystem::path& other) {
    const auto compared = [](const std::string& first, const std::string& second) {
        std::string_view a = first;
        std::string_view b = second;
        while (!a.empty() && !b.empty()) {
            if (isDigit(a.front()) && isDigit(b.front())) {
                const std::string_view x = takeNumber(a);
                const std::string_view y = takeNumber(b);
                if (x.size() != y.size()) return x.size() <=> y.size();
                if (x != y) return x <=> y;
            } else {
                if (a.front() != b.front()) return std::strong_ordering(a.front() <=> b.front());
                a.remove_prefix(1);
                b.remove_prefix(1);
            }
        }
        return a.size() <=> b.size();
    };
    // The stem first: "shot" is before "shot (1)", though a space is before a point.
    const auto stems = compared(lowerCase(one.stem().string()), lowerCase(other.stem().string()));
    if (std::is_neq(stems)) return std::is_lt(stems);
    const auto names = compared(lowerCase(one.filename().string()), lowerCase(other.filename().string()));
    return std::is_neq(names) ? std::is_lt(names) : one.filename().string() < other.filename().string();
}

std::vector<std::filesystem::path> imagesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> images = entriesOf(folder);
    std::erase_if(images, [](const auto& file) {
        std::error_code ignored; // a broken link is reported when the file is read
        return !isImageName(file) || std::filesystem::is_directory(file, ignored);
    });
    if (images.empty())
        throw DataError(folder.string(), "holds no picture that can be read",
                        "give the folder of the images: PNG, JPEG, BMP, TIFF, PGM or WebP");
    return images;
}

std::vector<std::filesystem::path> foldersIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> folders = entriesOf(folder);
    std::erase_if(folders, [](const auto& entry) {
        std::error_code ignored; // one that begins with a point is being written
        return !std::filesystem::is_directory(entry, ignored) || entry.filename().string().starts_with('.');
    });
    return folders;
}

namespace {

/// Whether the first pictures of a pose have two greys and no more: the patterns themselves, as a camera never sees
/// them.
bool isDrawnPattern(const CapturedView& view) {
    for (std::size_t i = 0; i < std::min<std::size_t>(2, view.files.size()); ++i) {
        cv::Mat grey;
        try {
            grey = readGrey(view.files[i], view.name);
        } catch (const CaptureRefused&) { // the error is reported when the pose is read
            return false;
        }
        double least = 0.0;
        double most = 0.0;
        cv::minMaxLoc(grey, &least, &most);
        if (least == most || cv::countNonZero((grey == least) | (grey == most)) != static_cast<int>(grey.total()))
            return false;
    }
    return true;
}

/// "a.cr2, b.cr2 and 3 more"
std::string someOf(const std::vector<std::filesystem::path>& files) {
    constexpr std::size_t kMost = 3;
    std::string names;
    for (std::size_t i = 0; i < std::min(kMost, files.size()); ++i)
        names += (i > 0 ? ", " : "") + inQuotes(files[i].filename().string());
    if (files.size() > kMost) names += " and " + std::to_string(files.size() - kMost) + " more";
    return names;
}

Finding passedOver(const std::string& view, const std::string& file, const std::string& why) {
    return {Cause::passedOver, view, file, why, "nothing, where it is none of the capture"};
}

} // namespace

CaptureListing listCapture(const std::filesystem::path& folder) {
    CaptureListing all;
    std::vector<std::filesystem::path> beside;
    for (const std::filesystem::path& entry : entriesOf(folder)) {
        const std::string name = entry.filename().string();
        if (isHousekeeping(entry)) continue;
        std::error_code ignored;
        if (!std::filesystem::is_directory(entry, ignored)) {
            if (isImageName(entry)) beside.push_back(entry);
            continue;
        }
        CapturedView view{name, {}};
        std::vector<std::filesystem::path> others;
        for (const std::filesystem::path& file : entriesOf(entry)) {
            if (isImageName(file) && !std::filesystem::is_directory(file, ignored))
                view.files.push_back(file);
            else if (!isHousekeeping(file))
                others.push_back(file);
        }
        if (!others.empty() || view.files.empty())
            all.passedOver.push_back(
                passedOver(name, "",
                           (others.empty() ? "holds no picture" : someOf(others) + ": no picture that can be read") +
                               std::string(", passed over")));
        if (!view.files.empty() && isDrawnPattern(view))
            all.passedOver.push_back(
                passedOver(name, "", "holds the patterns themselves, not what a camera saw of them: passed over"));
        else if (!view.files.empty())
            all.views.push_back(std::move(view));
    }
    if (all.views.empty() && !beside.empty())
        throw DataError(folder.string(), "holds pictures, but no folders of them: " + someOf(beside),
                        "give the folder in which each pose has a folder of its own");
    if (!beside.empty())
        all.passedOver.push_back(passedOver("", "", someOf(beside) + ": beside the folders of the poses, passed over"));
    if (all.views.empty())
        throw DataError(folder.string(),
                        all.passedOver.empty() ? "holds no folder with images"
                                               : "holds no pose: " + sentenceOf(all.passedOver.front()),
                        "give a folder with one folder of pictures for each pose: PNG, JPEG, BMP, TIFF, PGM or WebP");
    return all;
}

std::vector<CapturedView> viewsIn(const std::filesystem::path& folder) { return listCapture(folder).views; }

std::optional<Finding> dropStrangers(CapturedView& view, std::size_t patterns) {
    if (view.files.size() <= patterns) return std::nullopt;
    std::map<std::pair<std::string, std::pair<int, int>>, std::vector<std::filesystem::path>> kinds;
    for (const std::filesystem::path& file : view.files) {
        cv::Size size;
        try {
            size = readGrey(file, view.name).size();
        } catch (const CaptureRefused&) { // what cannot be read is a kind of its own
            size = {};
        }
        kinds[{lowerCase(file.extension().string()), {size.width, size.height}}].push_back(file);
    }
    const auto isLossy = [](const std::string& ending) {
        return ending == ".jpg" || ending == ".jpeg" || ending == ".jpe" || ending == ".webp";
    };
    const std::vector<std::filesystem::path>* chosen = nullptr;
    for (const auto& [kind, files] : kinds) // a camera may write each picture twice: without loss is better
        if (files.size() == patterns && (chosen == nullptr || !isLossy(kind.first))) chosen = &files;
    if (chosen == nullptr) return std::nullopt;
    std::vector<std::filesystem::path> strangers = view.files;
    std::erase_if(strangers, [&](const auto& file) { return std::ranges::count(*chosen, file) > 0; });
    view.files = *chosen;
    return passedOver(view.name, "", someOf(strangers) + ": of another size or kind than the images, passed over");
}

bool isLabCapture(const std::filesystem::path& folder) {
    std::error_code none;
    return std::filesystem::exists(folder / kLabCaptureMark, none) ||
           std::filesystem::exists(folder / "truth.json", none);
}

namespace {

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

/// A PNG of 16 bits a channel, of which `decodeImage` keeps 8.
bool isDeepPng(std::span<const std::byte> bytes) {
    constexpr std::size_t kDepth = 24; // place of the bit depth, PNG (W3C) 11.2.2
    return startsWith(bytes, "\x89PNG") && bytes.size() > kDepth && bytes[kDepth] == std::byte{16};
}

cv::Mat greyOf(const Image& image) {
    const glm::ivec2 size = image.size();
    cv::Mat grey(size.y, size.x, CV_8U);
    const Image::Pixel* from = image.pixels().data();
    for (int y = 0; y < size.y; ++y)
        for (uchar* to = grey.ptr(y); to != grey.ptr(y) + size.x; ++to, ++from) // Rec. 601, exact for greys
            *to = static_cast<uchar>((299 * (*from)[0] + 587 * (*from)[1] + 114 * (*from)[2] + 500) / 1000);
    return grey;
}

/// What OpenCV reads, as grey of 8, 16 or 32 bits (which are floating). Empty where it is no picture.
cv::Mat decodeOther(std::span<const std::byte> bytes) {
    const cv::Mat data(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::byte*>(bytes.data()));
    cv::Mat image;
    try {
        image = cv::imdecode(data, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) { // too large, or broken
        return {};
    }
    if (image.empty()) return {};
    const int depth = image.depth() == CV_8U ? CV_8U : image.depth() == CV_16U ? CV_16U : CV_32F;
    image.convertTo(image, depth);
    if (image.channels() == 2) cv::extractChannel(image, image, 0); // grey with alpha
    if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    if (image.channels() == 4) cv::cvtColor(image, image, cv::COLOR_BGRA2GRAY);
    return image;
}

/// One image as grey of as many bits as it has.
cv::Mat readDeepGrey(const std::filesystem::path& file, const std::string& view) {
    const auto refuse = [&](const std::string& why) {
        throw CaptureRefused({Cause::unreadableImage, view, file.filename().string(), why, "capture this pose again"});
    };
    cv::Mat grey;
    try {
        const std::vector<std::byte> bytes = readFile(file, kMostImageBytes);
        const bool isOurs = startsWith(bytes, "\x89PNG") || startsWith(bytes, "\xFF\xD8");
        if (isOurs || bytes.empty()) {
            const Image image = decodeImage(bytes, file.filename().string()); // looks at the size before it unpacks
            if (!isDeepPng(bytes)) grey = greyOf(image);
        }
        if (grey.empty()) grey = decodeOther(bytes);
    } catch (const DataError& error) {
        refuse(error.why());
    }
    if (grey.empty()) refuse("is no picture that can be read");
    if (static_cast<std::int64_t>(grey.total()) > kMaxDecodedPixels)
        refuse("has " + sizeText(grey) + " pixels, too many");
    if (grey.cols < kFewestPixels || grey.rows < kFewestPixels) refuse("has only " + sizeText(grey) + " pixels");
    return grey;
}

/// The end of the scale of images of more than 8 bits: whole bits of a sensor, of which a file of 16 may use 10, 12 or
/// 14. Black images alone say nothing of it, hence all of a pose.
double fullScaleOf(std::span<const cv::Mat> images) {
    double most = 0.0;
    for (const cv::Mat& image : images) {
        double least = 0.0;
        double here = 0.0;
        cv::minMaxLoc(image, &least, &here);
        most = std::max(most, here);
    }
    if (images.front().depth() == CV_32F) return most > 1.0 ? most : 1.0;
    for (const int bits : {10, 12, 14})
        if (most < (1 << bits)) return (1 << bits) - 1;
    return 65535.0;
}

void toEightBits(std::span<cv::Mat> images) {
    if (std::ranges::all_of(images, [](const cv::Mat& image) { return image.depth() == CV_8U; })) return;
    std::vector<cv::Mat> deep;
    for (const cv::Mat& image : images)
        if (image.depth() != CV_8U) deep.push_back(image);
    const double scale = 255.0 / fullScaleOf(deep);
    for (cv::Mat& image : images)
        if (image.depth() != CV_8U) image.convertTo(image, CV_8U, scale);
}

} // namespace

cv::Mat readGrey(const std::filesystem::path& file, const std::string& view) {
    cv::Mat grey = readDeepGrey(file, view);
    toEightBits({&grey, 1});
    return grey;
}

std::vector<cv::Mat> readImages(const CapturedView& view) {
    std::vector<cv::Mat> images;
    for (const std::filesystem::path& file : view.files) {
        images.push_back(readDeepGrey(file, view.name));
        if (images.back().size() != images.front().size())
            throw CaptureRefused(
                {Cause::imageSize, view.name, file.filename().string(),
                 "is " + sizeText(images.back()) + " pixels, the images before it " + sizeText(images.front()),
                 "capture this pose again with one camera setting"});
    }
    toEightBits(images);
    return images;
}

} // namespace lumorph
