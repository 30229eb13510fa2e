#include "core/loop/program_stage.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>

#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/loop/stage_timer.h"
#include "core/loop/tracked_room.h"
#include "core/loop/viewer_stage.h"
#include "core/mdf/placement.h"

namespace lumorph {

namespace {

[[noreturn]] void refuse(const std::string& why, const std::string& remedy) {
    throw InvalidInput("target of the servos", why, remedy);
}

bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The upper face of the highest voxel that is set in a column, device metres; NaN for none.
float topOf(const BitColumns& voxels, const VoxelFrame& frame, const glm::vec2& at) {
    const glm::dvec2 cell = (glm::dvec2(at) - glm::dvec2(frame.origin.x, frame.origin.z)) / frame.voxelSize;
    const glm::ivec2 column(glm::floor(cell));
    const glm::ivec3 size = frame.dimensions;
    if (column.x < 0 || column.y < 0 || column.x >= size.x || column.y >= size.z)
        return std::numeric_limits<float>::quiet_NaN();
    const auto words = static_cast<std::size_t>(voxels.wordsPerColumn());
    const std::span<const std::uint64_t> bits =
        voxels.words().subspan(voxels.columnIndex(column.x, column.y) * words, words);
    for (std::size_t w = words; w-- > 0;)
        if (bits[w] != 0)
            return static_cast<float>(static_cast<double>(frame.origin.y) +
                                      frame.voxelSize * (64.0 * static_cast<double>(w) + std::bit_width(bits[w])));
    return std::numeric_limits<float>::quiet_NaN();
}

void checkVoxels(const MatchWish& wish, const BitColumns* voxels) {
    if (!voxels) refuse("its voxels are missing", "give nothing instead");
    if (wish.field && voxels->dimensions() != wish.field->field.frame.dimensions)
        refuse("its voxels are not those of the field's frame", "give as many as the frame has along each axis");
}

} // namespace

MatchWish ProgramStage::ask(const MatchWish& wish, double sinceLast, std::span<const double> strokes,
                            const Clock& clock, MatchFrame& frame) {
    moves_ = false;
    if (!wish.program) {
        program_ = nullptr;
        rest();
        return wish;
    }
    if (const std::string* why = endOf(wish.program)) {
        if (wish.inputs) (void)wish.inputs->take(); // nobody is left for them
        frame.programError = *why;
        rest();
        return wish;
    }
    begin(wish, sinceLast);
    frame.program = wish.program;
    frame.programSeconds = seconds_;
    if (wish.inputs) frame.inputs = wish.inputs->take();
    lookAround(wish, frame);
    try {
        return answered(wish, strokes, clock, frame);
    } catch (const std::exception& failure) {
        end(wish, failure.what(), frame);
    } catch (...) {
        end(wish, "for an unknown reason", frame);
    }
    return wish;
}

/// The program's clock: the sum of the steps since it was asked first.
void ProgramStage::begin(const MatchWish& wish, double sinceLast) {
    const bool goesOn = program_ == wish.program;
    program_ = wish.program;
    step_ = goesOn ? sinceLast : 0.0;
    seconds_ = goesOn ? seconds_ + sinceLast : 0.0;
    if (goesOn) return;
    field_ = nullptr;
    if (split_) split_->restart();
}

/// Servos follow nothing of a program: the next time begins anew.
void ProgramStage::rest() {
    matches_ = newVoxels_ = false;
    field_ = nullptr;
    shape_ = nullptr;
    splitStrokes_.clear();
    if (split_) split_->restart();
}

void ProgramStage::lookAround(const MatchWish& wish, MatchFrame& frame) {
    bodies_.clear();
    worldFromDevice_ = wish.installation->worldFromDevice;
    if (!wish.poses) return;
    const Microseconds then =
        frame.time + Microseconds(std::llround(1e6 * lookAhead(*wish.installation, wish.lightDelay)));
    for (const PoseBoard::Entry& entry : wish.poses->entries()) {
        const std::optional<Pose> seen = entry.stream->at(then, frame.time);
        if (!seen) continue;
        const Pose pose = inRoom(*wish.installation, entry.role, *seen);
        bodies_.push_back({entry.name, entry.role, pose});
        if (entry.role == PoseRole::device) worldFromDevice_ = glm::mat4(matrixOf(pose));
    }
    moves_ = !bodies_.empty();
}

MatchWish ProgramStage::answered(const MatchWish& wish, std::span<const double> strokes, const Clock& clock,
                                 MatchFrame& frame) {
    ShowMoment moment;
    moment.seconds = seconds_;
    moment.step = step_;
    moment.bodies = bodies_;
    moment.strokes = strokes;
    moment.rig = wish.rig;
    moment.field = wish.field;
    moment.installation = wish.installation;
    moment.worldFromDevice = worldFromDevice_;
    moment.eye = frame.eye;
    moment.inputs = frame.inputs;
    moment.language = wish.language;
    ShowContent content;
    {
        const StageTimer timer(clock, frame.ms.program);
        content = wish.program->frame(moment);
        if (content.scene && content.scene != checked_) checkScene(*content.scene);
        checked_ = content.scene;
    }
    frame.sounds = std::move(content.sounds);
    frame.caption = std::move(content.caption);
    frame.keepsake = std::move(content.keepsake);
    frame.comparesBend = content.comparesBend;
    MatchWish shown = wish;
    if (content.scene) {
        shown.scene = content.scene;
        shown.assets = content.assets ? content.assets : noAssets_;
    }
    use(shown, content, clock, frame);
    moves_ |= content.moves || (!splitStrokes_.empty() && !split_->atRest());
    return shown;
}

void ProgramStage::use(const MatchWish& wish, const ShowContent& content, const Clock& clock, MatchFrame& frame) {
    const bool none = std::holds_alternative<std::monostate>(content.target);
    const bool lightAlone = wish.scene && wish.scene->showing == Showing::virtualOnly;
    if (wish.driver != Driver::program || none || lightAlone) return rest();
    if (const Mesh* mesh = std::get_if<Mesh>(&content.target)) checkMeshOnce(*mesh);
    if (const Voxels* voxels = std::get_if<Voxels>(&content.target)) checkVoxels(wish, voxels->get());
    if (const HeightGrid* grid = std::get_if<HeightGrid>(&content.target)) checkHeightGrid(*grid);
    if (content.following == Following::split) {
        matches_ = newVoxels_ = false;
        field_ = nullptr;
        const StageTimer timer(clock, frame.ms.rule);
        if (!wish.field && std::holds_alternative<Voxels>(content.target)) return rest();
        split(wish, content);
    } else {
        splitStrokes_.clear();
        if (split_) split_->restart();
        const StageTimer timer(clock, frame.ms.voxelize);
        match(wish, content);
    }
}

/// A mesh that moves keeps its triangles, which say whether it is closed; that takes long to find out.
void ProgramStage::checkMeshOnce(const Mesh& mesh) {
    if (!mesh) refuse("its mesh is missing", "give nothing instead");
    if (mesh == soundMesh_) return;
    const std::size_t triangles = mesh->triangles.size();
    if (triangles == 0 || triangles > kMaxTriangles)
        refuse("it has " + std::to_string(triangles) + " triangles, not 1 to " + std::to_string(kMaxTriangles),
               "give a simpler mesh");
    if (!std::ranges::all_of(mesh->positions, isFinite))
        refuse("a corner of its mesh is not finite", "give finite positions");
    const bool known = soundMesh_ && soundMesh_->positions.size() == mesh->positions.size() &&
                       soundMesh_->triangles == mesh->triangles;
    if (!known && !isClosedSolid(*mesh)) refuse("its mesh is not closed", "close it; a program's mesh is not repaired");
    soundMesh_ = mesh;
}

void ProgramStage::match(const MatchWish& wish, const ShowContent& content) {
    matches_ = wish.field != nullptr;
    newVoxels_ = false;
    if (!matches_) return;
    const Field& field = wish.field->field;
    std::shared_ptr<const void> shape;
    if (const Mesh* mesh = std::get_if<Mesh>(&content.target)) shape = *mesh;
    if (const Voxels* voxels = std::get_if<Voxels>(&content.target)) shape = *voxels;
    const bool sameField = field_ == wish.field;
    if (shape && sameField && shape == shape_) return;
    std::swap(before_, voxels_.written());
    if (const HeightGrid* grid = std::get_if<HeightGrid>(&content.target))
        voxelizeHeights(field.frame, *grid, static_cast<double>(field.restSurface), voxels_.written());
    else if (const Mesh* mesh = std::get_if<Mesh>(&content.target))
        voxelizer_.voxelize(field.frame, (*mesh)->positions, (*mesh)->triangles, voxels_.written());
    else
        voxels_.written() = *std::get<Voxels>(content.target);
    voxels_.keepDomain(wish.field);
    newVoxels_ = !sameField || !(voxels_.bits() == before_);
    field_ = wish.field;
    shape_ = std::move(shape);
}

void ProgramStage::split(const MatchWish& wish, const ShowContent& content) {
    if (splitRig_ != wish.rig) {
        split_.emplace(*wish.rig);
        reader_.emplace(split_->points());
        splitRig_ = wish.rig;
    }
    heights_.assign(split_->points().size(), std::numeric_limits<float>::quiet_NaN());
    heightsAt(wish, content, heights_);
    splitStrokes_ = split_->strokes(heights_, step_);
}

void ProgramStage::heightsAt(const MatchWish& wish, const ShowContent& content, std::span<float> heights) {
    const std::span<const glm::vec2> points = split_->points();
    if (const Mesh* mesh = std::get_if<Mesh>(&content.target))
        return reader_->read((*mesh)->positions, (*mesh)->triangles, heights);
    const HeightGrid* grid = std::get_if<HeightGrid>(&content.target);
    for (std::size_t p = 0; p < points.size(); ++p)
        heights[p] = grid ? static_cast<float>(heightAt(*grid, glm::dvec2(points[p])))
                          : topOf(*std::get<Voxels>(content.target), wish.field->field.frame, points[p]);
}

void ProgramStage::describe(MatchFrame& frame) const {
    if (!matches_) return;
    frame.matched = true;
    frame.targetVolume = static_cast<double>(voxels_.count()) * field_->field.frame.voxelVolume();
    frame.shareUnreachable = voxels_.shareUnreachable();
}

void ProgramStage::end(const MatchWish& wish, const std::string& why, MatchFrame& frame) {
    frame.programError = "The show program has ended, and the show goes on without it: " + why;
    std::erase_if(ended_, [](const auto& end) { return end.first.expired(); });
    ended_.emplace_back(wish.program, frame.programError);
    program_ = nullptr;
    moves_ = false;
    rest();
}

const std::string* ProgramStage::endOf(const std::shared_ptr<ShowProgram>& program) {
    const auto same = [&](const auto& end) { return !end.first.expired() && end.first.lock() == program; };
    const auto found = std::ranges::find_if(ended_, same);
    return found == ended_.end() ? nullptr : &found->second;
}

} // namespace lumorph
