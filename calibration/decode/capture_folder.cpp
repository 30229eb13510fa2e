#include "calibration/decode/capture_folder.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <system_error>

#include "core/base/file.h"
#include "core/base/image.h"

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

bool isImageName(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
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
    const std::string first = one.filename().string();
    const std::string second = other.filename().string();
    std::string_view a = first;
    std::string_view b = second;
    while (!a.empty() && !b.empty()) {
        if (isDigit(a.front()) && isDigit(b.front())) {
            const std::string_view x = takeNumber(a);
            const std::string_view y = takeNumber(b);
            if (x.size() != y.size()) return x.size() < y.size();
            if (x != y) return x < y;
        } else {
            if (a.front() != b.front()) return a.front() < b.front();
            a.remove_prefix(1);
            b.remove_prefix(1);
        }
    }
    return a.size() != b.size() ? a.size() < b.size() : first < second;
}

std::vector<std::filesystem::path> imagesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> images = entriesOf(folder);
    std::erase_if(images, [](const auto& file) { return !isImageName(file) || std::filesystem::is_directory(file); });
    if (images.empty()) throw DataError(folder.string(), "holds no PNG or JPEG", "give the folder of the images");
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

std::vector<CapturedView> viewsIn(const std::filesystem::path& folder) {
    std::vector<CapturedView> views;
    for (const std::filesystem::path& entry : foldersIn(folder))
        if (std::ranges::any_of(entriesOf(entry), isImageName))
            views.push_back({entry.filename().string(), imagesIn(entry)});
    if (views.empty())
        throw DataError(folder.string(), "holds no folder with images", "give a folder with one folder for each pose");
    return views;
}

bool isLabCapture(const std::filesystem::path& folder) {
    std::error_code none;
    return std::filesystem::exists(folder / kLabCaptureMark, none) ||
           std::filesystem::exists(folder / "truth.json", none);
}

cv::Mat readGrey(const std::filesystem::path& file, const std::string& view) {
    const auto refuse = [&](Cause cause, const std::string& why) {
        throw CaptureRefused({cause, view, file.filename().string(), why, "capture this pose again"});
    };
    Image image;
    try {
        image = decodeImage(readFile(file, kMostImageBytes), file.filename().string());
    } catch (const DataError& error) {
        refuse(Cause::unreadableImage, error.why());
    }
    const glm::ivec2 size = image.size();
    if (size.x < kFewestPixels || size.y < kFewestPixels)
        refuse(Cause::unreadableImage,
               "has only " + std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels");
    cv::Mat grey(size.y, size.x, CV_8U);
    const Image::Pixel* from = image.pixels().data();
    for (int y = 0; y < size.y; ++y)
        for (uchar* to = grey.ptr(y); to != grey.ptr(y) + size.x; ++to, ++from) // Rec. 601, exact for greys
            *to = static_cast<uchar>((299 * (*from)[0] + 587 * (*from)[1] + 114 * (*from)[2] + 500) / 1000);
    return grey;
}

std::vector<cv::Mat> readImages(const CapturedView& view) {
    std::vector<cv::Mat> images;
    for (const std::filesystem::path& file : view.files) {
        images.push_back(readGrey(file, view.name));
        if (images.back().size() != images.front().size())
            throw CaptureRefused(
                {Cause::imageSize, view.name, file.filename().string(),
                 "is " + sizeText(images.back()) + " pixels, the images before it " + sizeText(images.front()),
                 "capture this pose again with one camera setting"});
    }
    return images;
}

} // namespace lumorph
