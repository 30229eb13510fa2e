#include "app/studio/document/session_folder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include <QString>

#include "app/studio/document/kept_work.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/document/scene_files.h"
#include "app/studio/document/session_memory.h"
#include "core/base/error.h"
#include "core/scene/project_assets.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr const char* kProjectName = kSessionFile;
constexpr const char* kAssets = "session files"; // as takeAsset calls it
constexpr const char* kPartial = "partial";
constexpr const char* kKept = "kept";              // files of scenes whose originals have gone
constexpr const char* kKeepsakes = "applications"; // what those want kept
constexpr const char* kBroken = "broken-";
constexpr const char* kTemporary = ".lumorph-"; // as writeFileAtomically calls it
constexpr const char* kKey = kSessionKey;

constexpr std::size_t kMostBroken = 3;
constexpr std::chrono::hours kBrokenKept{30 * 24};

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

ProjectSource withMemory(const SessionState& session, const std::string& replacedAs) {
    ProjectSource source = session.source;
    if (!source.extras.view.is_object()) source.extras.view = nlohmann::json::object();
    const StudioState& state = source.state;
    source.extras.view[kKey] = {
        {"file", utf8Of(session.file)},      {"modified", session.modified},        {"rig", utf8Of(state.rig.path)},
        {"field", utf8Of(state.field.path)}, {"target", utf8Of(state.target.path)}, {"scene", sceneFiles(state)},
        {"rigInMemory", !source.stamps.rig}, {"demo", session.demo.name},           {"plays", session.demo.plays},
        {"told", session.demo.told},         {"lastEdit", session.lastEdit},        {"edits", session.edits}};
    if (!replacedAs.empty()) source.extras.view[kKey]["replacedAs"] = replacedAs;
    return source;
}

void removeQuietly(const fs::path& path) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

/// Names of what lies in a folder; none where there is no such folder.
std::vector<fs::path> namesIn(const fs::path& folder) {
    std::vector<fs::path> names;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        names.push_back(at->path().filename());
    return names;
}

/// Of an asset's name, or path, the part right below the folder; empty where it does not lie there.
fs::path nameBelow(const fs::path& folder, const fs::path& path) {
    const fs::path below = path.lexically_relative(folder);
    return below.empty() || *below.begin() == ".." || *below.begin() == "." ? fs::path() : *below.begin();
}

void removeAllBut(const std::set<fs::path>& needed, const fs::path& folder) {
    for (const fs::path& name : namesIn(folder))
        if (!needed.contains(name)) removeQuietly(folder / name);
}

/// Sessions that could not be opened may hold what somebody misses, but not for ever. One that goes is called
/// unfinished first: a folder that lost some of its files to a kill would be the newest of them.
void clearBroken(const fs::path& folder) {
    std::vector<std::pair<fs::file_time_type, fs::path>> broken; // newest first
    for (const fs::path& name : namesIn(folder)) {
        std::error_code failed;
        const auto time = fs::last_write_time(folder / name, failed);
        if (name.string().starts_with(kBroken) && !failed) broken.emplace_back(time, folder / name);
    }
    std::sort(broken.rbegin(), broken.rend());
    const auto oldest = fs::file_time_type::clock::now() - kBrokenKept;
    for (std::size_t k = 0; k < broken.size(); ++k) {
        if (k < kMostBroken && broken[k].first >= oldest) continue;
        const fs::path going = folder / (kTemporary + broken[k].second.filename().string());
        std::error_code failed;
        fs::rename(broken[k].second, going, failed);
        removeQuietly(failed ? broken[k].second : going);
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
void renameScene(StudioState& state, const nlohmann::json& memory, const fs::path& session, const fs::path& folder) {
    const auto files = memory.find("scene");
    if (files == memory.end() || !files->is_array()) return;
    Scene scene = *state.scene;
    std::size_t next = 0;
    renameAssets(scene, [&](const std::string& asset) {
        const std::string copies = session.string() + "/";
        const std::size_t at = next++;
        std::string original =
            at < files->size() && (*files)[at].is_string() ? (*files)[at].get<std::string>() : std::string();
        std::error_code ignored;
        if (!asset.starts_with(copies)) return asset; // bundled
        if (fs::exists(original, ignored)) return original;
        if (!fs::exists(asset, ignored)) return original.empty() ? asset : original;
        const fs::path kept = folder / kKept / "kept.lumorph";
        fs::create_directories(kept.parent_path(), ignored);
        return (kept.parent_path() / takeAsset(kept, asset)).string();
    });
    state.scene = std::make_shared<const Scene>(std::move(scene));
}

/// What applications of two studios wanted kept: the newer counts, the other stays beside it.
void adoptKeepsakes(const fs::path& from, const fs::path& to) {
    for (const fs::path& name : namesIn(from)) {
        std::error_code failed, none;
        const fs::path other = to / name;
        const bool there = fs::exists(other, failed);
        if (there && (sameBytes(from / name, other) ||
                      fs::last_write_time(from / name, failed) < fs::last_write_time(other, failed)))
            continue;
        fs::create_directories(to, none);
        if (there) fs::rename(other, to / (name.stem().string() + ".other-window" + name.extension().string()), none);
        fs::rename(from / name, other, none);
    }
}

std::string textIn(const nlohmann::json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// What an application was told; the file may be edited by hand.
DemoTold toldIn(const nlohmann::json& memory) {
    DemoTold told;
    const auto found = memory.find("told");
    if (found == memory.end() || !found->is_object()) return told;
    for (const auto& [name, text] : found->items())
        if (text.is_string()) told[name] = text.get<std::string>();
    return told;
}

} // namespace

SessionFolder::SessionFolder(fs::path folder) : folder_(std::move(folder)) {
    const std::vector<int> numbers = numbersIn(folder_);
    if (!numbers.empty()) found_ = numbers.front();
}

void SessionFolder::write(const SessionState& session) { write(session, {}); }

void SessionFolder::writeReplaced(const SessionState& session, const std::string& id) {
    write(session, id);
    replaced_ = true;
}

void SessionFolder::write(const SessionState& session, const std::string& replacedAs) {
    try {
        std::error_code ignored;
        const bool there =
            number_ > 0 && !replaced_ && fs::exists(sessionFolder(folder_, number_) / kProjectName, ignored);
        there ? writeAgain(session, replacedAs) : writeAnew(session, replacedAs);
        if (!cleared_) clear(session);
        cleared_ = true;
    } catch (const fs::filesystem_error& error) {
        throw DeviceError("session", "it cannot be kept in " + folder_.string() + ": " + error.code().message(),
                          "free some disk space, or check the folder's permissions");
    }
}

/// A new number: complete under another name first, then renamed; then the older ones go.
void SessionFolder::writeAnew(const SessionState& session, const std::string& replacedAs) {
    fs::create_directories(folder_);
    const std::vector<int> old = numbersIn(folder_);
    const int number = old.empty() ? 1 : old.front() + 1;
    const fs::path partial = folder_ / kPartial;
    fs::remove_all(partial);
    fs::create_directories(partial);
    TakenAssets taken = saveProject(withMemory(session, replacedAs), partial / kProjectName);
    fs::rename(partial, sessionFolder(folder_, number));
    number_ = number;
    replaced_ = cleared_ = false;
    last_ = session.source.state;
    taken_ = std::move(taken);
}

/// The project's file is replaced at once; files that it named before go after that.
void SessionFolder::writeAgain(const SessionState& session, const std::string& replacedAs) {
    const StudioState& state = session.source.state;
    TakenAssets there;
    if (state.rig == last_.rig) there.rig = taken_.rig;
    if (state.field == last_.field) there.field = taken_.field;
    if (state.target == last_.target) there.target = taken_.target;
    if (state.assets == last_.assets) there.scene = taken_.scene;
    const fs::path place = sessionFolder(folder_, number_);
    TakenAssets taken = saveProject(withMemory(session, replacedAs), place / kProjectName, {}, there);
    last_ = state;
    if (taken == taken_) return;
    taken_ = std::move(taken);
    std::set<fs::path> needed;
    const auto need = [&needed](const std::string& name) { needed.insert(nameBelow(kAssets, name)); };
    for (const std::string& name : {taken_.rig, taken_.field, taken_.target}) need(name);
    for (const auto& [inMemory, name] : taken_.scene) need(name);
    removeAllBut(needed, place / kAssets);
}

void SessionFolder::clear(const SessionState& session) const {
    for (const fs::path& name : namesIn(folder_)) {
        const std::optional<int> number = numberOf(name);
        const bool unfinished = name == kPartial || name.string().starts_with(kTemporary);
        if (number && *number != number_ && *number != restored_) {
            const SessionMemory memory = readSessionMemory(folder_ / name);
            // Of what other programs left the newest may be edited work; the others are what it replaced.
            if (!memory.replacedAs.empty() || (*number == found_ && memory.modified)) {
                keepWork(folder_ / name, folder_, memory.replacedAs);
                continue;
            }
        }
        if (unfinished || (number && *number != number_)) removeQuietly(folder_ / name);
    }
    clearBroken(folder_);
    std::set<fs::path> needed;
    const fs::path kept = folder_ / kKept / (std::string(kKept) + " files");
    for (const nlohmann::json& file : sceneFiles(session.source.state))
        needed.insert(nameBelow(kept, file.get<std::string>()));
    removeAllBut(needed, kept);
}

std::optional<RestoredSession> SessionFolder::restore(const fs::path& folder, const fs::path& copies,
                                                      const Progress& progress) {
    const std::vector<int> numbers = numbersIn(folder);
    if (numbers.empty()) return std::nullopt;
    RestoredSession restored = restoreFrom(sessionFolder(folder, numbers.front()), copies, progress);
    restored.number = numbers.front();
    return restored;
}

RestoredSession SessionFolder::restoreFrom(const fs::path& place, const fs::path& copies, const Progress& progress) {
    LoadedProject loaded = loadProjectWithoutAssets(place / kProjectName, progress.part(0.0, 0.8));
    const nlohmann::json memory = loaded.extras.view.is_object() && loaded.extras.view.contains(kKey)
                                      ? loaded.extras.view[kKey]
                                      : nlohmann::json::object();
    RestoredSession restored;
    SessionState& session = restored.session;
    session.file = textIn(memory, "file");
    session.modified = memory.is_object() && memory.value("modified", true);
    session.demo = {textIn(memory, "demo"), memory.is_object() && memory.value("plays", false), toldIn(memory)};
    if (loaded.extras.view.is_object()) loaded.extras.view.erase(kKey);
    StudioState& state = loaded.state;
    // An edited rig is in no file, though it goes by the name of the one that was opened.
    const bool rigInMemory = memory.is_object() && memory.value("rigInMemory", false);
    rename(state.rig.path, loaded.stamps.rig, textIn(memory, "rig"), place);
    rename(state.field.path, loaded.stamps.field, textIn(memory, "field"), place);
    rename(state.target.path, loaded.stamps.target, textIn(memory, "target"), place);
    if (rigInMemory) loaded.stamps.rig.reset();
    renameScene(state, memory, place, copies);
    loadAssets(loaded, place / kProjectName, progress.part(0.8, 1.0));
    session.source = {std::move(loaded.state), loaded.stamps, std::move(loaded.extras)};
    return restored;
}

bool SessionFolder::hasSession(const fs::path& folder) { return !numbersIn(folder).empty(); }

void SessionFolder::adopt(const fs::path& from, const fs::path& to, Adopted session) {
    for (const KeptWork& work : keptWorkIn(from))
        if (!work.thrown) keepWork(placeOfKeptWork(from, work.id), to, work.id);
    adoptKeepsakes(from / kKeepsakes, to / kKeepsakes);
    const std::vector<int> numbers = numbersIn(from);
    for (const int number : numbers) {
        const fs::path place = sessionFolder(from, number);
        const SessionMemory memory = readSessionMemory(place);
        const bool adopts = session == Adopted::edited && number == numbers.front() && memory.modified;
        if (adopts || !memory.replacedAs.empty()) keepWork(place, to, memory.replacedAs);
    }
}

fs::path SessionFolder::moveAside(const fs::path& folder) {
    const std::vector<int> numbers = numbersIn(folder);
    std::error_code ignored;
    for (int i = 1; !numbers.empty() && i < 10'000; ++i) {
        fs::path aside = folder / (kBroken + std::to_string(i));
        if (fs::exists(aside, ignored)) continue;
        fs::rename(sessionFolder(folder, numbers.front()), aside, ignored);
        return aside;
    }
    return {};
}

} // namespace lumorph::studio
