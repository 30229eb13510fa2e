#include <memory>

#include "app/cli/commands.h"
#include "app/cli/field_input.h"
#include "core/voxels/nrrd.h"

namespace lumorph::cli {

namespace {

struct VoxelizeArguments {
    TargetArguments target;
    std::string like;
    std::string output;
};

void voxelize(const VoxelizeArguments& arguments, const Session& session) {
    checkOutput(arguments.output, arguments.target.path);
    const Field field = readFieldFile(session, arguments.like);
    const TargetVoxels voxels = readTarget(session, field, arguments.target);
    printWarnings(voxels.warnings);
    session.throwIfCancelled();
    writeOutput(arguments.output,
                writeNrrd(bytesOf(field.frame, voxels.bits), arguments.target.surface ? "surface" : "target"));
}

} // namespace

void addVoxelizeCommand(CLI::App& app, Session& session) {
    auto a = std::make_shared<VoxelizeArguments>();
    CLI::App* command = app.add_subcommand("voxelize", "Turn a mesh into voxels of a field's frame");
    command
        ->add_option("mesh", a->target.path,
                     "A .glb, .gltf, .obj, .stl, .ply or .off file (- for GLB or OBJ on standard input)")
        ->required();
    command->add_option("--like", a->like, "The field whose frame to use")->required();
    command->add_flag("--fit", a->target.fit, "Largest scale inside the frame, centred, standing on the rest surface");
    command->add_flag("--surface", a->target.surface,
                      "The voxels that the mesh's surface meets, borders included, instead of those inside it; the "
                      "mesh may be open");
    command->add_option("-o,--output", a->output, "The .nrrd file to write, or -")->required();
    command->callback([a, &session] { voxelize(*a, session); });
}

} // namespace lumorph::cli
