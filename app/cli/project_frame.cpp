#include "app/cli/project_frame.h"

#include <memory>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/show/project_contents.h"
#include "core/show/show_player.h"

namespace lumorph::cli {

namespace {

constexpr std::string_view kResource = "resource:";
constexpr int kDefaultLevels = 33;

} // namespace

std::filesystem::path projectFile(const std::string& name) {
    if (!name.starts_with(kResource)) return name;
    if (!isAssetName(name))
        throw DataError(name, "it leaves the resources' folder",
                        "name a bundled project such as projects/NAME.lumorph");
    return resourceFile(std::string_view(name).substr(kResource.size()));
}

ProjectFrame readProjectFrame(const std::filesystem::path& file, const ProjectMoment& moment, const Session& session) {
    ProjectContents contents = readContents(file, session.progress());
    Session::endProgress();
    if (moment.eye) contents.project.installation.eye = *moment.eye;
    MatchWish wish = wishOf(contents);
    wish.showTint = false;
    ProjectFrame result;
    std::shared_ptr<const MatchFrame> match;
    if (moment.state) {
        const std::vector<double> strokes =
            strokesOf(*wish.rig, *moment.state, wish.field ? wish.field->field.levels : kDefaultLevels);
        match = heldFrame(wish, strokes, moment.seconds);
    } else {
        ManualClock clock;
        match = ShowPlayer(clock, wish).playUntil(moment.seconds, session.progress());
        Session::endProgress();
    }
    result.frame = ShowStage().frame(*match);
    result.strokes = match->estimatedStrokes;
    result.warnings = contents.warnings;
    if (wish.target && contents.project.matching.driver == Driver::target && !wish.field && !moment.state)
        result.warnings.emplace_back("The project has no field, so the device does not follow its target.");
    return result;
}

} // namespace lumorph::cli
