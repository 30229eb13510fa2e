#include "app/cli/new_demo.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/resources.h"

namespace lumorph::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostName = 30;
constexpr std::size_t kMostBytes = std::size_t{1} << 22;

/// Words that cannot name a namespace, or that would hide what an application uses.
constexpr std::array<std::string_view, 46> kTakenWords{
    "alignas",  "alignof", "auto",   "bool",    "break",  "case",     "catch",  "char",     "class",  "const",
    "continue", "default", "delete", "do",      "double", "else",     "enum",   "explicit", "export", "extern",
    "false",    "float",   "for",    "friend",  "glm",    "goto",     "if",     "inline",   "int",    "long",
    "lumorph",  "main",    "new",    "private", "public", "registry", "return", "short",    "signed", "static",
    "std",      "struct",  "switch", "this",    "true",   "void"};

void checkName(const std::string& name) {
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    if (name.empty() || name.size() > kMostName || !std::ranges::all_of(name, fits) || name.front() < 'a' ||
        name.find("__") != std::string::npos || name.back() == '_')
        throw InvalidInput("demo '" + name + "'", "this cannot be its name",
                           "use small letters, digits and _, the first a letter, at most 30");
    if (std::ranges::find(kTakenWords, name) != kTakenWords.end())
        throw InvalidInput("demo '" + name + "'", "the word has a meaning of its own", "choose another one");
}

std::string textOf(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMostBytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

/// "ripple_ring" as "RippleRing" and as "Ripple ring".
std::string asClass(const std::string& name) {
    std::string made;
    bool begins = true;
    for (const char c : name) {
        if (c != '_') made += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = c == '_';
    }
    return made;
}
std::string asTitle(std::string name) {
    std::ranges::replace(name, '_', ' ');
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return name;
}
/// The function that gives it: "rippleRing" before "Demo".
std::string asFunction(const std::string& name) {
    std::string made = asClass(name);
    made.front() = name.front();
    return made;
}

std::string exampleAs(const std::string& name, const char* file) {
    std::string text = textOf(resourceFile(std::string("examples/demo/") + file));
    for (const char* title : {"\"Example\"", "\"Beispiel\""}) replaceAll(text, title, "\"" + asTitle(name) + "\"");
    replaceAll(text, "Example", asClass(name));
    replaceAll(text, "exampleDemo", asFunction(name) + "Demo");
    replaceAll(text, "example", name);
    return text;
}

struct Edit {
    fs::path file; ///< relative to the tree
    std::string text;
};

[[noreturn]] void noPlace(const fs::path& file) {
    throw DataError(file.string(), "there is no place for another application",
                    "name it by hand, as CONTRIBUTING.md says under 'A new demonstration'");
}

/// Puts a line among those that begin alike, by the alphabet.
void insertLine(std::string& text, std::string_view alike, const std::string& line, const fs::path& file) {
    std::size_t end = std::string::npos;
    for (std::size_t at = text.find(alike); at != std::string::npos; at = text.find(alike, at + 1)) {
        if (at > 0 && text[at - 1] != '\n') continue;
        const std::size_t lineEnd = text.find('\n', at);
        if (lineEnd == std::string::npos) break;
        if (std::string_view(text).substr(at, lineEnd - at) > line) {
            text.insert(at, line + "\n");
            return;
        }
        end = lineEnd + 1;
    }
    if (end == std::string::npos) noPlace(file);
    text.insert(end, line + "\n");
}

Edit inBuild(const fs::path& tree, const std::string& name) {
    const fs::path file = "app/applications/CMakeLists.txt";
    std::string text = textOf(tree / file);
    // Before the registry, whatever the alphabet says: the list is one of the folders, in the end.
    const std::size_t at = text.find("    registry/demos.cpp\n");
    if (at == std::string::npos) noPlace(file);
    text.insert(at, "    " + name + "/" + name + ".cpp\n");
    return {file, text};
}

Edit inRegistry(const fs::path& tree, const std::string& name) {
    const fs::path file = "app/applications/registry/demos.cpp";
    std::string text = textOf(tree / file);
    std::string include = "#include \"app/applications/" + name;
    include += "/" + name + ".h\"";
    insertLine(text, "#include \"app/applications/", include, file);
    const std::size_t list = text.find("std::vector<Demo> all{");
    const std::size_t end = text.find("};", list);
    if (list == std::string::npos || end == std::string::npos) noPlace(file);
    text.insert(end, ",\n                                       " + name + "::" + asFunction(name) + "Demo()");
    return {file, text};
}

Edit inFolderOrder(const fs::path& tree, const std::string& name) {
    const fs::path file = "packaging/folder_order.txt";
    std::string text = textOf(tree / file);
    const std::size_t at = text.find("\napp/applications/registry\n");
    if (at == std::string::npos) noPlace(file);
    text.insert(at, "\napp/applications/" + name);
    return {file, text};
}

std::string folderReadme(const std::string& name) {
    return "The application \"" + asTitle(name) +
           "\": what visitors see and feel of it.\n"
           "May use `app/applications` and `core`; no other application, no Qt.\n";
}

void write(const fs::path& file, const std::string& text) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error); // what is wrong with it, writing will say
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace

std::vector<fs::path> writeNewDemo(const fs::path& tree, const std::string& name) {
    checkName(name);
    if (!fs::exists(tree / "app/applications/registry/demos.cpp"))
        throw DataError(tree.string(), "this is not Lumorph's source tree",
                        "go to the folder that holds CMakeLists.txt and app, or name it with --tree");
    const fs::path own = fs::path("app/applications") / name;
    if (fs::exists(tree / own))
        throw InvalidInput("demo '" + name + "'", "there is one already", "choose another name");
    // All is made before anything is written, so that a tree that has no place for it stays as it is.
    const std::vector<Edit> edits{
        {own / (name + ".h"), exampleAs(name, "example.h")},
        {own / (name + ".cpp"), exampleAs(name, "example.cpp")},
        {own / "README.md", folderReadme(name)},
        {fs::path("resources/thumbnails") / (name + ".png"), textOf(resourceFile("examples/demo/example.png"))},
        inBuild(tree, name),
        inFolderOrder(tree, name),
        inRegistry(tree, name)};
    std::vector<fs::path> written;
    for (const Edit& edit : edits) {
        write(tree / edit.file, edit.text);
        written.push_back(edit.file);
    }
    return written;
}

} // namespace lumorph::cli
