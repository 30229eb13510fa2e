#include "app/studio/document/session_keeper.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <utility>

#include "app/studio/document/scene_edit.h"
#include "app/studio/document/scene_files.h"
#include "core/base/error.h"
#include "core/scene/project_assets.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr int kSoonMilliseconds = 3000;
constexpr const char* kProjectName = "session.lumorph";
constexpr const char* kPartial = "partial";
constexpr const char* kKey = "session"; // in the project's view

std::optional<int> numberOf(const fs::path& folder) {
    const std::string name = folder.filename().string();
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
    return number;
}

/// Numbers of the complete sessions, newest first.
std::vector<int> numbersIn(const fs::path& folder) {
    std::vector<int> numbers;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (const auto number = numberOf(at->path())) numbers.push_back(*number);
    std::sort(numbers.rbegin(), numbers.rend());
    return numbers;
}

fs::path sessionFolder(const fs::path& folder, int number) { return folder / std::to_string(number); }

/// Json holds nothing but UTF-8; a name that is none gets replacement characters.
std::string utf8Of(const fs::path& path) { return QString::fromStdString(path.string()).toStdString(); }

/// Where each file that the scene names lies, in the order in which the scene names them.
nlohmann::json sceneFiles(const StudioState& state) {
    nlohmann::json files = nlohmann::json::array();
    if (!state.scene) return files;
    Scene scene = *state.scene;
    renameAssets(scene, [&files](const std::string& asset) {
        files.push_back(utf8Of(asset));
        return asset;
    });
    return files;
}

ProjectSource withMemory(const SessionState& session) {
    ProjectSource source = session.source;
    if (!source.extras.view.is_object()) source.extras.view = nlohmann::json::object();
    const StudioState& state = source.state;
    source.extras.view[kKey] = {{"file", utf8Of(session.file)},        {"modified", session.modified},
                                {"rig", utf8Of(state.rig.path)},       {"field", utf8Of(state.field.path)},
                                {"target", utf8Of(state.target.path)}, {"scene", sceneFiles(state)},
                                {"rigInMemory", !source.stamps.rig}};
    return source;
}

/// A new number: complete under another name first, then renamed, then the older ones go.
int writeAnew(const fs::path& folder, const SessionState& session) {
    fs::create_directories(folder);
    const std::vector<int> old = numbersIn(folder);
    const int number = old.empty() ? 1 : old.front() + 1;
    const fs::path partial = folder / kPartial;
    fs::remove_all(partial);
    fs::create_directories(partial);
    saveProject(withMemory(session), partial / kProjectName);
    fs::rename(partial, sessionFolder(folder, number));
    for (const int older : old) fs::remove_all(sessionFolder(folder, older));
    return number;
}

bool sameAssets(const StudioState& a, const StudioState& b) {
    return a.rig == b.rig && a.field == b.field && a.target == b.target && sceneFiles(a) == sceneFiles(b);
}

void write(const fs::path& folder, const SessionState& session, SessionKeeper::Written& last) {
    try {
        const bool same = last.number > 0 && sameAssets(last.assets, session.source.state) &&
                          fs::exists(sessionFolder(folder, last.number) / kProjectName);
        if (same) { // the large files are there already; the project's file is replaced at once
            saveProject(withMemory(session), sessionFolder(folder, last.number) / kProjectName);
        } else {
            last.number = writeAnew(folder, session);
            last.assets = session.source.state;
        }
    } catch (const fs::filesystem_error& error) {
        throw DeviceError("session", "it cannot be kept in " + folder.string() + ": " + error.code().message(),
                          "free some disk space, or check the folder's permissions");
    }
}

bool sameBytes(const fs::path& a, const fs::path& b) {
    std::error_code failed;
    if (fs::file_size(a, failed) != fs::file_size(b, failed) || failed) return false;
    std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
    return first && second &&
           std::equal(std::istreambuf_iterator<char>(first), std::istreambuf_iterator<char>(),
                      std::istreambuf_iterator<char>(second));
}

bool sameContents(const fs::path& a, const fs::path& b) {
    std::error_code failed;
    if (!fs::is_directory(a, failed) || !fs::is_directory(b, failed)) return sameBytes(a, b);
    for (fs::directory_iterator at(a, failed), end; !failed && at != end; at.increment(failed))
        if (!sameBytes(at->path(), b / at->path().filename())) return false;
    return !failed;
}

/// An asset was read from the session's copy and goes by the name it had. Where that file is another one by now its
/// stamp says so.
void rename(fs::path& path, std::optional<FileStamp>& stamp, const std::string& original, const fs::path& session) {
    const std::string copies = session.string() + "/";
    if (!path.string().starts_with(copies)) return; // bundled
    if (original.empty())
        stamp.reset();
    else
        stamp = sameContents(path, original) ? stampOf(original) : FileStamp{true, 0, fs::file_time_type::min()};
    path = original;
}

/// The scene's files go by the names they had. A copy whose original has gone moves to where no later session clears
/// it away.
void renameScene(StudioState& state, const nlohmann::json& memory, const fs::path& session) {
    const auto files = memory.find("scene");
    if (files == memory.end() || !files->is_array()) return;
    Scene scene = *state.scene;
    std::size_t next = 0;
    renameAssets(scene, [&](const std::string& asset) {
        const std::string copies = session.string() + "/";
        const std::size_t at = next++;
        const std::string original =
            at < files->size() && (*files)[at].is_string() ? (*files)[at].get<std::string>() : std::string();
        std::error_code ignored;
        if (!asset.starts_with(copies)) return asset; // bundled
        if (fs::exists(original, ignored)) return original;
        if (!fs::exists(asset, ignored)) return original.empty() ? asset : original;
        const fs::path kept = session.parent_path() / "kept" / "kept.lumorph";
        fs::create_directories(kept.parent_path(), ignored);
        return (kept.parent_path() / takeAsset(kept, asset)).string();
    });
    state.scene = std::make_shared<const Scene>(std::move(scene));
}

std::string textIn(const nlohmann::json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

} // namespace

SessionKeeper::SessionKeeper(fs::path folder, std::function<std::optional<SessionState>()> snapshot, QObject* parent)
    : QObject(parent), folder_(std::move(folder)), snapshot_(std::move(snapshot)) {
    soon_.setSingleShot(true);
    soon_.setInterval(kSoonMilliseconds);
    connect(&soon_, &QTimer::timeout, this, &SessionKeeper::keepBeside);
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    lock_ = std::make_unique<QLockFile>(QString::fromStdString((folder_ / "lock").string()));
    lock_->setStaleLockTime(0); // only that of a program that is gone
    if (!lock_->tryLock()) lock_.reset();
}

void SessionKeeper::touch() {
    if (lock_ && !soon_.isActive()) soon_.start();
}

void SessionKeeper::keepBeside() {
    if (writing_) { // a large target on a slow disk
        soon_.start();
        return;
    }
    std::optional<SessionState> session = snapshot_();
    if (!session) return;
    writing_ = true;
    writer_ = std::jthread([this, kept = std::move(*session)] {
        try {
            write(folder_, kept, written_);
        } catch (const Error& error) {
            const QString why = QString::fromStdString(error.why() + "; " + error.remedy());
            QMetaObject::invokeMethod(
                this, [this, why] { emit failed(why); }, Qt::QueuedConnection);
        }
        writing_ = false;
    });
}

void SessionKeeper::keepNow() {
    soon_.stop();
    if (writer_.joinable()) writer_.join();
    const std::optional<SessionState> session = snapshot_();
    if (lock_ && session) write(folder_, *session, written_);
}

std::optional<SessionState> SessionKeeper::restore(const fs::path& folder, const Progress& progress) {
    const std::vector<int> numbers = numbersIn(folder);
    if (numbers.empty()) return std::nullopt;
    const fs::path place = sessionFolder(folder, numbers.front());
    LoadedProject loaded = loadProjectWithoutAssets(place / kProjectName, progress.part(0.0, 0.8));
    const nlohmann::json memory = loaded.extras.view.is_object() && loaded.extras.view.contains(kKey)
                                      ? loaded.extras.view[kKey]
                                      : nlohmann::json::object();
    SessionState session;
    session.file = textIn(memory, "file");
    session.modified = memory.is_object() && memory.value("modified", true);
    if (loaded.extras.view.is_object()) loaded.extras.view.erase(kKey);
    StudioState& state = loaded.state;
    // An edited rig is in no file, though it goes by the name of the one that was opened.
    const bool rigInMemory = memory.is_object() && memory.value("rigInMemory", false);
    rename(state.rig.path, loaded.stamps.rig, textIn(memory, "rig"), place);
    rename(state.field.path, loaded.stamps.field, textIn(memory, "field"), place);
    rename(state.target.path, loaded.stamps.target, textIn(memory, "target"), place);
    if (rigInMemory) loaded.stamps.rig.reset();
    renameScene(state, memory, place);
    loadAssets(loaded, place / kProjectName, progress.part(0.8, 1.0));
    session.source = {std::move(loaded.state), loaded.stamps, std::move(loaded.extras)};
    return session;
}

fs::path SessionKeeper::moveAside(const fs::path& folder) {
    const std::vector<int> numbers = numbersIn(folder);
    std::error_code ignored;
    for (int i = 1; !numbers.empty() && i < 10'000; ++i) {
        const fs::path aside = folder / ("broken-" + std::to_string(i));
        if (fs::exists(aside, ignored)) continue;
        fs::rename(sessionFolder(folder, numbers.front()), aside, ignored);
        return aside;
    }
    return {};
}

} // namespace lumorph::studio
