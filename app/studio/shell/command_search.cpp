#include "app/studio/shell/command_search.h"

#include <algorithm>

namespace lumorph::studio {
namespace {

constexpr double kLetter = 1.0, kWordStart = 4.0, kNextToEachOther = 3.0, kFromTheStart = 3.0, kPerLetterLeft = 0.02;
constexpr double kWorthShowing = 0.4; ///< of the best score; less is letters found by chance

constexpr double kByMenu = 0.6, kByOtherWord = 0.7, kByKind = 0.6;

/// What else a command may be called by someone who looks for it.
struct OtherWords {
    const char* id;
    const char* words;
};
constexpr OtherWords kOtherWords[] = {
    {"file.new", "create empty begin"},
    {"file.open", "load import file rig model mesh"},
    {"file.save", "store keep"},
    {"file.quit", "exit close leave"},
    {"edit.undo", "revert take back"},
    {"edit.redo", "repeat again"},
    {"settings", "preferences options configuration"},
    {"view.theme", "dark mode bright mode appearance colours colors"},
    {"view.sound.on", "audio volume mute silent noise music"},
    {"view.sound.louder", "volume up audio"},
    {"view.sound.quieter", "volume down audio softer"},
    {"view.fullScreen", "maximise maximize presentation fullscreen"},
    {"view.resetLayout", "restore docks panels windows"},
    {"loop.stop", "halt emergency panic freeze"},
    {"loop.resume", "continue go on"},
    {"help.guide", "manual documentation handbook help pages how to"},
    {"help.shortcuts", "hotkeys keys bindings manual"},
    {"field.story", "mdf explain learn story voxels tutorial"},
    {"help.tour", "introduction tutorial guide"},
    {"help.about", "version licence license"},
    {"labyrinth.levels", "editor draw paint maze game own"},
    {"target.open", "load import shape model mesh"},
    {"target.remove", "delete clear"},
    {"target.fit", "scale size centre center"},
    {"target.autoPlace", "optimise optimize best position align"},
    {"target.spin", "rotate turn"},
    {"target.play", "animation pause"},
    {"rig.open", "load import device"},
    {"rig.new", "create make begin template rig import mesh gltf obj folder states joints"},
    {"rig.save", "export write glb device"},
    {"rig.rest", "home zero neutral flat reset pose"},
    {"rig.random", "shuffle"},
    {"rig.dance", "animate demo wiggle"},
    {"poses.keep", "save remember name store snapshot pose"},
    {"poses.play", "sequence timeline animation keyframes choreography"},
    {"poses.export", "arduino standalone without computer sketch sequence flash"},
    {"view.dock.poses", "sequence timeline animation keyframes choreography"},
    {"match.live", "follow track drive"},
    {"match.refined", "optimise optimize accurate"},
    {"match.voting", "equation fast"},
    {"calibrate.chain", "millimetres boxes whole chain sequence registration delays light"},
    {"calibrate.chain.pointer", "pointer tip pivot swing stylus dimple recordings"},
    {"calibrate.chain.tracker", "tracker world registration hand-eye board markers recordings"},
    {"calibrate.chain.device", "device body landmarks touch model registration recordings"},
    {"calibrate.chain.eye", "head glasses viewer alignment eye"},
    {"calibrate.chain.light", "light response curve gamma black white colour color paper seam camera exposure"},
    {"calibrate.chain.servos", "servos measured backlash play curves camera"},
    {"calibrate.chain.check", "verify check still good drift moved recalibrate"},
    {"field.build", "mdf voxels distance compute calculate"},
    {"export.parts", "print stl 3mf build make housing seat servo wiring assembly sketch fabricate"},
    {"export.picture", "screenshot image snapshot photo"},
    {"export.turntable", "film movie animation"},
    {"applications", "cards games demos examples welcome play visitors"},
    {"view.language", "german translation"},
    {"record.start", "capture log film video"},
    {"output.identify", "beamer number which"},
    {"output.close", "beamer blank off"},
    {"device.connect", "attach plug usb arduino board servo"},
    {"device.start", "enable motors power on"},
    {"device.release", "disable motors limp power off detach"},
};

bool startsWord(const QString& text, qsizetype at) { return at == 0 || !text[at - 1].isLetterOrNumber(); }

} // namespace

/// The best way to lay the letters over the text, by one table row a letter: `best[at]` is the best score with the
/// newest letter at `at`.
std::optional<double> searchScore(const QString& typed, const QString& text) {
    const QString letters = typed.simplified().remove(' ').toCaseFolded();
    const QString in = text.toCaseFolded();
    if (letters.isEmpty()) return 0.0;
    constexpr double kNone = -1.0;
    std::vector<double> best(static_cast<std::size_t>(in.size()), kNone);
    for (qsizetype letter = 0; letter < letters.size(); ++letter) {
        std::vector<double> next(best.size(), kNone);
        double before = kNone; // best with the letter before anywhere to the left
        for (std::size_t at = 0; at < best.size(); ++at) {
            const auto position = static_cast<qsizetype>(at);
            const bool fits = in[position] == letters[letter];
            const double own = kLetter + (startsWord(in, position) ? kWordStart : 0.0);
            if (fits && letter == 0) next[at] = own + (at == 0 ? kFromTheStart : 0.0);
            if (fits && letter > 0) {
                const double joined = at > 0 && best[at - 1] >= 0.0 ? best[at - 1] + kNextToEachOther : kNone;
                const double from = std::max(joined, before);
                if (from >= 0.0) next[at] = from + own;
            }
            before = std::max(before, best[at]);
        }
        best = std::move(next);
    }
    const double score = best.empty() ? kNone : *std::max_element(best.begin(), best.end());
    if (score < 0.0) return std::nullopt;
    return score - kPerLetterLeft * static_cast<double>(in.size() - letters.size());
}

QString commandTitle(const QAction& action) {
    QString title = action.text().section('\t', 0, 0);
    title.remove('&').remove("...").remove(QChar(0x2026));
    return title.trimmed();
}

namespace {

/// Each typed word begins one of the other words: letters that are scattered over a long list say nothing.
bool isOtherWord(const QString& typed, const QString& id) {
    const auto entry = std::ranges::find(kOtherWords, id, [](const OtherWords& one) { return QString(one.id); });
    const QStringList words = typed.simplified().toCaseFolded().split(' ', Qt::SkipEmptyParts);
    if (entry == std::end(kOtherWords) || words.isEmpty()) return false;
    const QStringList others = QString(entry->words).split(' ');
    return std::ranges::all_of(words, [&](const QString& word) {
        return word.size() > 1 &&
               std::ranges::any_of(others, [&](const QString& other) { return other.startsWith(word); });
    });
}

std::optional<double> scoreOf(const Commands::Entry& entry, const QString& typed) {
    if (!entry.action->isVisible()) return std::nullopt;
    auto score = searchScore(typed, commandTitle(*entry.action));
    // The menu's name finds its commands too, behind those that are called so.
    if (const auto inMenu = searchScore(typed, entry.options.menu + ' ' + commandTitle(*entry.action)))
        score = std::max(score.value_or(0.0), *inMenu * kByMenu);
    if (isOtherWord(typed, entry.action->objectName()))
        score = std::max(score.value_or(0.0), searchScore(typed, typed).value_or(0.0) * kByOtherWord);
    return score;
}

std::optional<double> scoreOf(const Findable& thing, const QString& typed) {
    auto score = searchScore(typed, thing.title);
    if (const auto byKind = searchScore(typed, thing.kind + ' ' + thing.title))
        score = std::max(score.value_or(0.0), *byKind * kByKind);
    return score;
}

template <class Entry> std::vector<Entry> bestFirst(std::vector<std::pair<double, Entry>> found) {
    std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Entry> entries;
    for (auto& [score, entry] : found)
        if (score >= found.front().first * kWorthShowing) entries.push_back(std::move(entry));
    return entries;
}

} // namespace

std::vector<Found> searchAll(const Commands& commands, const QString& typed) {
    std::vector<std::pair<double, Found>> found;
    for (const Commands::Entry& entry : commands.all())
        if (const auto score = scoreOf(entry, typed)) found.push_back({*score, {entry.action, entry.options.menu, {}}});
    if (!typed.trimmed().isEmpty())
        for (Findable& thing : commands.findables())
            if (const auto score = scoreOf(thing, typed)) found.push_back({*score, {nullptr, {}, std::move(thing)}});
    return bestFirst(std::move(found));
}

std::vector<Commands::Entry> searchCommands(const Commands& commands, const QString& typed) {
    std::vector<std::pair<double, Commands::Entry>> found;
    for (const Commands::Entry& entry : commands.all())
        if (const auto score = scoreOf(entry, typed)) found.emplace_back(*score, entry);
    return bestFirst(std::move(found));
}

} // namespace lumorph::studio
