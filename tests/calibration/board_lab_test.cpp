#include "calibration/lab/board_lab.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/decode/pattern_decoder.h"
#include "core/base/error.h"

namespace lumorph::test {
namespace {

/// The virtual lab with pictures of fewer pixels.
Installation smallLab(glm::ivec2 size) {
    Installation room = defaultInstallation();
    InstalledCamera& camera = room.cameras.emplace_back();
    camera.camera = withSize(defaultLabCamera(room.projectors.front().camera), size);
    return room;
}

void showWhite(BoardLab& lab) {
    const glm::ivec2 size = lab.projector().camera.size;
    lab.show(cv::Mat(size.y, size.x, CV_8U, cv::Scalar(255)));
}

/// Where OpenCV puts a world point in a camera.
cv::Point2d byOpenCv(const CalibratedCamera& camera, const glm::dvec3& point) {
    const glm::dvec4 local = camera.cameraFromWorld * glm::dvec4(point, 1.0);
    const cv::Matx33d matrix(camera.focal.x, 0.0, camera.principal.x, 0.0, camera.focal.y, camera.principal.y, 0.0, 0.0,
                             1.0);
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{local.x, local.y, local.z}}, cv::Vec3d(), cv::Vec3d(), matrix,
                      cv::Mat(1, 5, CV_64F, const_cast<double*>(camera.distortion.data())), pixels);
    return pixels.front();
}

/// How far the board is found from where it truly is, root mean square pixels; either way round.
double errorOf(const BoardLab& lab, const glm::dmat4& pose, const BoardPoints& found) {
    const std::vector<cv::Point3d> named = pointsOf(lab.board());
    const std::vector<glm::dvec3> truth = lab.points();
    double sum = 0.0;
    double turned = 0.0;
    for (std::size_t i = 0; i < found.seen.size(); ++i) {
        const auto at = static_cast<std::size_t>(std::ranges::find(named, found.board[i]) - named.begin());
        const cv::Point2d here = byOpenCv(lab.camera(), glm::dvec3(pose * glm::dvec4(truth.at(at), 1.0)));
        const cv::Point2d there =
            byOpenCv(lab.camera(), glm::dvec3(pose * glm::dvec4(truth.at(truth.size() - 1 - at), 1.0)));
        sum += (found.seen[i] - here).dot(found.seen[i] - here);
        turned += (found.seen[i] - there).dot(found.seen[i] - there);
    }
    return std::sqrt(std::min(sum, turned) / static_cast<double>(found.seen.size()));
}

TEST(BoardLab, BoardsAreSeenWhereOpenCvPutsThem) {
    for (const char* name : {"chess:9x7:25", "charuco:7x5:35:26", "circles:4x9:25"}) {
        BoardLabOptions options;
        options.tremble = 0.0;
        BoardLab lab(smallLab({960, 768}), parseCalibrationBoard(name), options, 3);
        showWhite(lab);
        for (const glm::dmat4& pose : lab.proposePoses(3)) {
            lab.lay(pose);
            const cv::Mat picture = lab.photograph();
            const auto found = findBoard(picture, lab.board());
            ASSERT_TRUE(found) << name;
            // A circle's middle is not the middle of its image where the board is tilted.
            EXPECT_LT(errorOf(lab, pose, *found), 0.16) << name;
        }
    }
}

} // namespace
} // namespace lumorph::test
