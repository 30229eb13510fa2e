#include "calibration/tracking/board_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/tracking/board_page.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;

TEST(BoardAddress, ReadsAllItsWords) {
    BoardAddress address;
    address.source = "/dev/video0";
    EXPECT_EQ(parseBoardAddress("board://camera0"), address);
    EXPECT_EQ(parseBoardAddress("board:///dev/video0"), address);
    address.source = "/home/anna/my video.mp4";
    address.board = {MarkerBoard::Kind::aruco, 4, 5, 0.035, 0.028, "6X6_250"};
    address.body = "tablet";
    address.lens = CameraLens{790.0, 791.5, 480.0, 270.0, {-0.12, 0.04, 0.001, -0.0008, 0.0}};
    address.place = CameraPlace{{0.15, 0.55, 0.45}, {0.0, 0.0, -0.1}};
    address.aboveMillimetres = 40.0;
    address.repeat = true;
    EXPECT_EQ(parseBoardAddress("board:///home/anna/my%20video.mp4?kind=aruco&squares=4x5&size=35&marker=28&"
                                "dictionary=6X6_250&name=tablet&lens=790,791.5,480,270,-0.12,0.04,0.001,-0.0008&"
                                "from=0.15,0.55,0.45&to=0,0,-0.1&above=40&repeat=yes"),
              address);
    EXPECT_EQ(parseBoardAddress("board://camera3?fov=78").fieldOfViewDegrees, 78.0);
    EXPECT_NEAR(parseBoardAddress("board://camera0?size=60").board.marker, 0.044, 1e-12) << "in proportion";
    EXPECT_TRUE(isBoardAddress("board://x"));
    EXPECT_FALSE(isBoardAddress("sim://head"));
}

TEST(BoardAddress, RefusesWhatIsNoneAndNamesIt) {
    for (const char* uri : {"",
                            "board://",
                            "sim://head",
                            "board://camera",
                            "board://cameraX",
                            "board://video.mp4",
                            "board:///",
                            "board://camera0?squares=5",
                            "board://camera0?squares=5x7x9",
                            "board://camera0?squares=1x1",
                            "board://camera0?squares=2.5x7",
                            "board://camera0?squares=x",
                            "board://camera0?size=0",
                            "board://camera0?size=nan",
                            "board://camera0?size=inf",
                            "board://camera0?marker=40",
                            "board://camera0?dictionary=9X9_1",
                            "board://camera0?kind=qr",
                            "board://camera0?lens=790",
                            "board://camera0?lens=790,790,480,x",
                            "board://camera0?lens=0,790,480,270",
                            "board://camera0?fov=0",
                            "board://camera0?from=1,2",
                            "board://camera0?to=1,2,3",
                            "board://camera0?from=0,0,0",
                            "board://camera0?repeat=maybe",
                            "board://camera0?name=",
                            "board://camera0?above=1e9",
                            "board://camera0?cow=1",
                            "board://camera0?size",
                            "board://camera0?squares=50x50"}) {
        try {
            (void)parseBoardAddress(uri);
            ADD_FAILURE() << uri << " was taken";
        } catch (const InvalidInput& error) {
            EXPECT_GT(std::string(error.what()).size(), 20U) << uri;
        }
    }
    try {
        (void)parseBoardAddress("board://camera0?sqares=5x7");
        ADD_FAILURE();
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.what(), HasSubstr("'board://camera0?sqares=5x7'"));
        EXPECT_THAT(error.what(), HasSubstr("nothing is known of 'sqares'"));
    }
}

TEST(BoardAddress, WhatAPageSaysOfItselfReadsAsTheSameBoard) {
    for (const MarkerBoard& board :
         {MarkerBoard{}, MarkerBoard{MarkerBoard::Kind::aruco, 4, 5, 0.0355, 0.028, "6X6_250"}})
        EXPECT_EQ(parseBoardWords(queryOf(board)), board) << queryOf(board);
}

} // namespace
} // namespace lumorph
