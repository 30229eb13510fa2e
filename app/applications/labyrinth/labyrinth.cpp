#include "app/applications/labyrinth/labyrinth.h"

#include <algorithm>
#include <string>
#include <utility>

#include <glm/matrix.hpp>

#include "core/base/error.h"

namespace lumorph::labyrinth {
namespace {

constexpr double kRest = 2.0;       ///< seconds in the goal until the next level
constexpr double kShownLean = 0.35; ///< of a lean: at most 5 degrees, 12 mm at the tablet's sides

const char* soundOf(GameEvent::Kind kind) {
    switch (kind) {
    case GameEvent::Kind::roll:
        return "labyrinth.roll";
    case GameEvent::Kind::bump:
        return "labyrinth.bump";
    case GameEvent::Kind::pickUp:
        return "labyrinth.pickup";
    case GameEvent::Kind::fall:
        return "labyrinth.fall";
    default:
        return "labyrinth.goal";
    }
}

/// Name and idea of the level, and how the run stands: another one each second.
std::shared_ptr<const ShowCaption> captionOf(const Level& level, std::size_t number, int seconds, int points) {
    const std::string count = std::to_string(number) + "  ";
    const std::string stands = "\n" + std::to_string(seconds) + " s, " + std::to_string(points);
    const std::string& german = level.ideaGerman.empty() ? level.idea : level.ideaGerman;
    return std::make_shared<const ShowCaption>(
        ShowCaption{{count + level.name, count + (level.nameGerman.empty() ? level.name : level.nameGerman)},
                    {level.idea + stands + " points", german + stands + " Punkte"}});
}

} // namespace

LabyrinthProgram::LabyrinthProgram(std::uint64_t seed, std::vector<Level> levels, std::vector<Ghost> best)
    : seed_(seed), levels_(std::move(levels)), best_(std::move(best)) {
    if (levels_.empty()) throw InvalidInput("labyrinth", "has no level", "give it one");
    pictures_ = boardPictures(levels_);
    begin(0);
}

void LabyrinthProgram::begin(std::size_t level) {
    number_ = level;
    rests_ = 0.0;
    game_.emplace(levels_[level], seed_ + level);
    pilot_.emplace(levels_[level], true);
    board_.emplace(*game_, *pictures_);
    relief_.emplace(levels_[level], game_->blocks());
    caption_ = nullptr;
}

ShowContent LabyrinthProgram::frame(const ShowMoment& moment) {
    visitor_.take(moment);
    turn();
    game_->advance(moment.step, playsItself() ? pilot_->lean(game_->ball(), game_->pickUps()) : visitor_.lean());
    ShowContent content;
    content.sounds = sounds();
    if (finish(moment.step)) content.keepsake = [best = best_] { return ghostsText(best); };
    Board::Beside beside{best(), rests_, boardLean(), std::nullopt};
    if (moment.eye) beside.eye = glm::dvec3(glm::inverse(moment.worldFromDevice) * glm::vec4(*moment.eye, 1.0F));
    content.scene = board_->show(*game_, beside);
    content.assets = board_->assets();
    const glm::dvec3& ball = game_->ball().position;
    content.target = game_->fallen() ? relief_->level(beside.lean) : relief_->withBall({ball.x, ball.z}, beside.lean);
    content.following = Following::split;
    const std::pair stands(static_cast<int>(game_->seconds()), game_->score());
    if (!caption_ || stands != std::exchange(stands_, stands))
        caption_ = captionOf(levels_[number_], number_ + 1, stands.first, stands.second);
    content.caption = caption_;
    return content;
}

glm::dvec2 LabyrinthProgram::boardLean() const noexcept {
    return kShownLean * (game_->lean() - (playsItself() ? glm::dvec2(0.0) : visitor_.leanOfDevice()));
}

/// Whoever comes begins anew, and who has gone leaves it to itself.
void LabyrinthProgram::turn() {
    if (visitor_.came() || visitor_.left()) return begin(0);
    if (visitor_.next()) return begin((number_ + 1) % levels_.size());
    if (visitor_.restart()) begin(number_);
}

/// Whether there is another best run now.
bool LabyrinthProgram::finish(double step) {
    if (!game_->done()) return false;
    const bool kept = rests_ == 0.0 && !playsItself() && keepRun();
    rests_ += step;
    if (rests_ > kRest) begin((number_ + 1) % levels_.size());
    return kept;
}

bool LabyrinthProgram::keepRun() {
    const Ghost& run = game_->run();
    if (run.seconds > Ghost::kMostSeconds) return false;
    const auto known = std::ranges::find(best_, run.level, &Ghost::level);
    if (known == best_.end())
        best_.push_back(run);
    else if (run.score > known->score)
        *known = run;
    else
        return false;
    return true;
}

const Ghost* LabyrinthProgram::best() const {
    const auto known = std::ranges::find(best_, game_->level().name, &Ghost::level);
    return known == best_.end() ? nullptr : &*known;
}

std::vector<ShowSound> LabyrinthProgram::sounds() const {
    std::vector<ShowSound> sounds;
    for (const GameEvent& event : game_->events())
        sounds.push_back({soundOf(event.kind), event.strength, glm::vec3(event.place)});
    return sounds;
}

Demo labyrinthDemo() {
    return {.name = "labyrinth",
            .title = {"A labyrinth under your hands", "Ein Labyrinth unter den Händen"},
            .sentence = {"Lean it, and the ball rolls: over ramps, bridges and stairs, past holes, to the green goal.",
                         "Neige es, und die Kugel rollt: über Rampen, Brücken und Treppen, an Löchern vorbei, ins "
                         "grüne Ziel."},
            .thumbnail = "thumbnails/labyrinth.png",
            .open = bundledTablet,
            .program = [](const ProgramStart& start, const Progress&) -> std::unique_ptr<ShowProgram> {
                std::vector<Ghost> best;
                if (!start.kept.empty()) best = readGhosts(start.kept, start.keptIn);
                return std::make_unique<LabyrinthProgram>(start.seed, bundledLevels(), std::move(best));
            },
            .keeps = true};
}

} // namespace lumorph::labyrinth
