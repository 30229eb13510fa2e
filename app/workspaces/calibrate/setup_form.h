#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QWidget>

#include "app/studio/widgets/segments.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/calibrate/board_drawing.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "calibration/tracking/camera_source.h"

class QVBoxLayout;

namespace lumorph::studio {

/// How it is calibrated: where pictures come from, the board in words and as a drawing, the projector and its patterns.
class SetupForm : public QWidget {
    Q_OBJECT
public:
    explicit SetupForm(const CalibrateParts& parts, QWidget* parent = nullptr);

private:
    void addSource(QVBoxLayout& column);
    void addBoard(QVBoxLayout& column);
    void addPatterns(QVBoxLayout& column);
    ValueField* addNumber(const QString& name, Quantity quantity, double low, double high, double usual);
    void listProjectors();
    void listPatterns();
    void listCameras();
    void listScreens();
    void searchCameras();
    void refresh();
    void edit(const std::function<void(CalibrationSetup&)>& change);

    CalibrateParts parts_;
    Segments* way_ = nullptr;
    QLabel* wayWords_ = nullptr;
    QWidget* installedRow_ = nullptr;
    QComboBox* installed_ = nullptr; ///< the room's projectors
    QWidget* screenRow_ = nullptr;
    QComboBox* screen_ = nullptr; ///< at which the projector is
    QWidget* rest_ = nullptr;     ///< what a board is calibrated with
    QPushButton* folder_ = nullptr;
    QPushButton* patterns_ = nullptr;
    QWidget* cameraRow_ = nullptr;
    QComboBox* camera_ = nullptr;
    QWidget* addressRow_ = nullptr;
    QLineEdit* address_ = nullptr;
    QPushButton* search_ = nullptr;
    std::vector<CameraInfo> networkCameras_; ///< that were found
    QWidget* savedRow_ = nullptr;
    QPushButton* saved_ = nullptr;
    QWidget* faultRow_ = nullptr;
    QComboBox* fault_ = nullptr;
    BoardDrawing* drawing_ = nullptr;
    QComboBox* kind_ = nullptr;
    ValueField* columns_ = nullptr;
    ValueField* rows_ = nullptr;
    ValueField* spacing_ = nullptr;
    ValueField* marker_ = nullptr;
    QLabel* countName_ = nullptr;
    QWidget* markerRow_ = nullptr;
    QComboBox* dictionary_ = nullptr; ///< of ChArUco
    QWidget* dictionaryRow_ = nullptr;
    QLabel* spacingName_ = nullptr;
    QWidget* projectorRow_ = nullptr;
    ValueField* width_ = nullptr;
    ValueField* height_ = nullptr;
    QComboBox* pattern_ = nullptr;
    QWidget* posesRow_ = nullptr;
    ValueField* poses_ = nullptr;
};

} // namespace lumorph::studio
