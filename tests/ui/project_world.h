#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "app/studio/document/project_service.h"
#include "core/base/atomic_file.h"
#include "core/geometry/mesh_writers.h"
#include "core/rig/rig_file.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

namespace lumorph::test {

/// A folder with files to open, and a session folder of its own.
class SessionFiles {
public:
    SessionFiles() {
        needApplication();
        ::setenv("LUMORPH_SESSION", (folder_ / "session").c_str(), 1);
        writeRig(cushionRig(), "cushion.glb");
        writeRig(lifterRig(), "lifter.glb");
        writeMesh(boxMesh({-0.02F, 0.0F, -0.01F}, {0.02F, 0.03F, 0.01F}), "block.obj");
    }
    ~SessionFiles() { ::unsetenv("LUMORPH_SESSION"); }

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
    void writeRig(const Rig& rig, const std::string& name) const {
        writeFileAtomically(folder_ / name, writeRigGlb(rig));
    }
    void writeMesh(const TriangleMesh& mesh, const std::string& name) const { writeText(name, writeObj(mesh)); }
    void writeText(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }

private:
    TemporaryFolder folder_;
};

/// A project service and what it works on, without a window.
struct ProjectWorld {
    studio::Notices notices;
    studio::Jobs jobs;
    studio::StudioDocument document;
    studio::ProjectService service{document, jobs, notices};

    [[nodiscard]] const studio::StudioState& state() const { return document.state(); }
    /// Until no job runs.
    [[nodiscard]] bool rest() {
        return eventually([&] { return jobs.running().empty(); });
    }
    void openRig(const std::filesystem::path& file) {
        service.openRig(file);
        (void)eventually([&] { return jobs.running().empty() && state().field.field; });
    }
    void openTarget(const std::filesystem::path& file) {
        service.openTarget(file);
        (void)rest();
    }
    /// The newest notice of a place; an empty one when there is none.
    [[nodiscard]] studio::Notice notice(const QString& place) const {
        const auto all = notices.at(place);
        return all.empty() ? studio::Notice{} : all.front();
    }
    /// Presses a notice's button. False when it has no such button.
    [[nodiscard]] bool press(const QString& place, const QString& button) {
        const studio::Notice shown = notice(place);
        for (const auto& action : shown.actions)
            if (action.text == button) {
                action.run();
                notices.dismiss(place, shown.subject);
                return true;
            }
        return false;
    }
};

/// A project service among files of its own.
struct ProjectServiceFixture : testing::Test {
    SessionFiles files; // before the service, which keeps its session among them
    ProjectWorld world;
};

} // namespace lumorph::test
