#pragma once

#include <functional>
#include <string>

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
/// What a command does with a folder of pictures in place of a project.
using FolderCommand = std::function<void(const std::string& folder, bool json)>;
/// Each adds what its kind of folder needs to the command of its stage.
[[nodiscard]] FolderCommand addRoomFolder(CLI::App& command, const Session& session);
[[nodiscard]] FolderCommand addMirrorFolder(CLI::App& command, const Session& session);
[[nodiscard]] FolderCommand addDeviceFolder(CLI::App& command, const Session& session);
/// Into the group of the calibrate commands.
void addCalibrateBudget(CLI::App& group, Session& session);
void addCalibrateImport(CLI::App& group);
void addCalibrateStages(CLI::App& group, Session& session);
void addCalibrateTracking(CLI::App& group, Session& session);
void addLabCommands(CLI::App& app, Session& session);
void addCamerasCommand(CLI::App& app);
/// Into the group of the lab.
void addPlacementCommand(CLI::App& group, Session& session);
void addLabRegisterCommand(CLI::App& group, Session& session);
/// Nor are these: devices and trackers are reached through Qt.
void addDeviceCommands(CLI::App& app, Session& session);
void addTrackCommand(CLI::App& app, Session& session);
/// Into the group of the track commands.
void addTrackReplay(CLI::App& group, Session& session);

} // namespace lumorph::cli
