#pragma once

#include <CLI/App.hpp>

#include "app/cli/session.h"

namespace lumorph::cli {

/// Each adds its group to the program; the session outlives the parsing.
void addRigCommands(CLI::App& app, Session& session);
/// Into the group of the rig commands.
void addRigReport(CLI::App& group, Session& session);
void addRigSearch(CLI::App& group, Session& session);
void addPartsCommand(CLI::App& group, Session& session);
void addMdfCommands(CLI::App& app, Session& session);
void addVoxelizeCommand(CLI::App& app, Session& session);
void addMatchCommand(CLI::App& app, Session& session);
void addProjectCommand(CLI::App& app, Session& session);
void addBenchCommand(CLI::App& app);
/// Like the benchmarks, demonstrations are another program's, which is executed.
void addDemoCommand(CLI::App& app, const Session& session);
/// Not part of a build of the core alone: recordings need SQLite, and the virtual lab stands on calibration.
void addRecordingCommands(CLI::App& app);
void addRenderCommand(CLI::App& app, Session& session);
void addCalibrateCommands(CLI::App& app, Session& session);
/// Adds those of several cameras and projectors, and of a mirror, to the group of the others.
void addCalibrateRoomCommands(CLI::App& group, Session& session);
/// Into the group of the calibrate commands.
void addCalibrateBudget(CLI::App& group, Session& session);
void addCalibrateDevice(CLI::App& group, Session& session);
void addCalibrateStages(CLI::App& group, Session& session);
void addCalibrateTracking(CLI::App& group, Session& session);
void addLabCommands(CLI::App& app, Session& session);
/// Into the group of the lab.
void addPlacementCommand(CLI::App& group, Session& session);
void addLabRegisterCommand(CLI::App& group, Session& session);
/// Nor are these: devices and trackers are reached through Qt.
void addDeviceCommands(CLI::App& app, Session& session);
void addTrackCommand(CLI::App& app, Session& session);

} // namespace lumorph::cli
