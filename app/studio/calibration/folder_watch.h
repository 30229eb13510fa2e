#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace lumorph::studio {

/// Looks again and again at the folders in a folder into which somebody photographs or copies: also where a network
/// tells nobody of new files. A thread of its own looks, so that a slow disk holds up nothing.
class FolderWatch {
public:
    struct Content {
        int files = 0;         ///< not counting hidden ones
        std::size_t print = 0; ///< of their names, sizes and times
        bool operator==(const Content&) const = default;
    };
    using Contents = std::map<std::string, Content>; ///< by the folder's name
    /// What is another since it was told last and was the same in two looks; in the window's thread. False: it is told
    /// again.
    using Told = std::function<bool(const Contents& changed)>;

    FolderWatch(std::filesystem::path folder, Told told,
                std::chrono::milliseconds every = std::chrono::milliseconds(1500));
    /// In the window's thread: nothing is told any more.
    ~FolderWatch();
    FolderWatch(const FolderWatch&) = delete;
    FolderWatch& operator=(const FolderWatch&) = delete;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_; ///< with the thread, which may still look when nobody wants it any more
};

} // namespace lumorph::studio
