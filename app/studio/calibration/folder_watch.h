#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace lumorph::studio {

/// Polls the subfolders of a folder for files that are added or changed. It polls because network drives send no change
/// notifications. A background thread does it, so that a slow disk does not block the window.
class FolderWatch {
public:
    struct Content {
        int files = 0;         ///< not counting hidden ones
        std::size_t print = 0; ///< of their names, sizes and times
        bool operator==(const Content&) const = default;
    };
    using Contents = std::map<std::string, Content>; ///< by the folder's name
    /// Called in the window's thread with the subfolders that have changed since the last accepted call and were the
    /// same in two polls in a row. Returns false to be called again after the next poll.
    using Told = std::function<bool(const Contents& changed)>;

    FolderWatch(std::filesystem::path folder, Told told,
                std::chrono::milliseconds every = std::chrono::milliseconds(1500));
    /// Call it in the window's thread; `told` is not called afterwards.
    ~FolderWatch();
    FolderWatch(const FolderWatch&) = delete;
    FolderWatch& operator=(const FolderWatch&) = delete;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_; ///< shared with the detached thread, which may outlive this
};

} // namespace lumorph::studio
