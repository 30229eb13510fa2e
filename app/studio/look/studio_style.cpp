#include "app/studio/look/studio_style.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QPainter>
#include <QStyleFactory>
#include <QStyleOption>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/look/style_drawing.h"

namespace lumorph::studio {
namespace {

/// The field around it draws the box.
bool liesInField(const QWidget& edit) {
    return qobject_cast<const QAbstractSpinBox*>(edit.parentWidget()) != nullptr ||
           qobject_cast<const QComboBox*>(edit.parentWidget()) != nullptr;
}

} // namespace

StudioStyle::StudioStyle() : QProxyStyle(QStyleFactory::create("Fusion")) { setObjectName("lumorph"); }

int StudioStyle::pixelMetric(PixelMetric metric, const QStyleOption* option, const QWidget* widget) const {
    switch (metric) {
    case PM_ScrollBarExtent:
        return 12;
    case PM_ScrollBarSliderMin:
        return 28;
    case PM_SliderThickness:
    case PM_SliderControlThickness:
        return 20;
    case PM_SliderLength:
        return 14;
    case PM_IndicatorWidth:
    case PM_IndicatorHeight:
    case PM_ExclusiveIndicatorWidth:
    case PM_ExclusiveIndicatorHeight:
    case PM_SmallIconSize:
    case PM_ButtonIconSize:
    case PM_ListViewIconSize:
    case PM_TabBarIconSize:
        return 16;
    case PM_MessageBoxIconSize:
        return 32;
    case PM_DockWidgetSeparatorExtent:
    case PM_SplitterWidth:
        return 5;
    case PM_DockWidgetFrameWidth:
        return 1; // of floating docks
    case PM_CheckBoxLabelSpacing:
    case PM_RadioButtonLabelSpacing:
        return 8;
    case PM_ButtonShiftHorizontal:
    case PM_ButtonShiftVertical:
        return 0;
    case PM_FocusFrameHMargin:
    case PM_FocusFrameVMargin:
        return 3;
    case PM_ToolBarItemSpacing:
        return 4;
    default:
        return QProxyStyle::pixelMetric(metric, option, widget);
    }
}

int StudioStyle::styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                           QStyleHintReturn* result) const {
    switch (hint) {
    case SH_EtchDisabledText:
    case SH_DitherDisabledText:
    case SH_ComboBox_Popup:
    case SH_Widget_Animation_Duration:
    case SH_DialogButtonBox_ButtonsHaveIcons:
        return 0;
    case SH_UnderlineShortcut:
        return QApplication::keyboardModifiers().testFlag(Qt::AltModifier) ? 1 : 0;
    case SH_Slider_AbsoluteSetButtons:
        return Qt::LeftButton;
    case SH_ToolTip_WakeUpDelay:
        return 500;
    default:
        return QProxyStyle::styleHint(hint, option, widget, result);
    }
}

void StudioStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                                const QWidget* widget) const {
    switch (element) {
    case PE_IndicatorCheckBox:
    case PE_IndicatorItemViewItemCheck:
    case PE_IndicatorRadioButton:
        drawMark(*painter, *option, element == PE_IndicatorRadioButton);
        return;
    case PE_IndicatorArrowDown:
        drawChevron(*painter, *option, 0);
        return;
    case PE_IndicatorArrowUp:
        drawChevron(*painter, *option, 180);
        return;
    case PE_IndicatorArrowRight:
        drawChevron(*painter, *option, -90);
        return;
    case PE_IndicatorArrowLeft:
        drawChevron(*painter, *option, 90);
        return;
    case PE_IndicatorBranch:
        if (option->state.testFlag(State_Children))
            drawChevron(*painter, *option, option->state.testFlag(State_Open) ? 0 : -90);
        return;
    case PE_IndicatorDockWidgetResizeHandle:
        drawSeparator(*painter, *option);
        return;
    case PE_PanelLineEdit:
        if (widget != nullptr && liesInField(*widget)) return;
        QProxyStyle::drawPrimitive(element, option, painter, widget);
        return;
    case PE_FrameFocusRect:
        return; // the ring is a widget of its own
    default:
        QProxyStyle::drawPrimitive(element, option, painter, widget);
    }
}

void StudioStyle::drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                              const QWidget* widget) const {
    if (element == CE_FocusFrame) {
        painter->setRenderHint(QPainter::Antialiasing);
        painter->setPen(QPen(currentPalette().accent, 2));
        painter->setBrush(Qt::NoBrush);
        painter->drawRoundedRect(QRectF(option->rect).adjusted(1, 1, -1, -1), 6, 6);
        return;
    }
    if (element == CE_Splitter) {
        drawSeparator(*painter, *option);
        return;
    }
    QProxyStyle::drawControl(element, option, painter, widget);
}

void StudioStyle::drawComplexControl(ComplexControl control, const QStyleOptionComplex* option, QPainter* painter,
                                     const QWidget* widget) const {
    if (const auto* slider = qstyleoption_cast<const QStyleOptionSlider*>(option)) {
        const QRect groove = subControlRect(control, option, SC_SliderGroove, widget);
        if (control == CC_Slider) {
            drawSlider(*painter, *slider, groove, subControlRect(control, option, SC_SliderHandle, widget));
            return;
        }
        if (control == CC_ScrollBar) {
            drawScrollBar(*painter, *slider, subControlRect(control, option, SC_ScrollBarSlider, widget));
            return;
        }
    }
    if (control == CC_ComboBox) {
        const auto* box = qstyleoption_cast<const QStyleOptionComboBox*>(option);
        drawField(*painter, *box, box->frame);
        drawChevronIn(*painter, *option, subControlRect(control, option, SC_ComboBoxArrow, widget), 0);
        return;
    }
    if (control == CC_SpinBox) {
        QStyleOptionComplex field = *option;
        field.state.setFlag(State_HasFocus, widget != nullptr && widget->hasFocus());
        drawField(*painter, field, true);
        drawChevronIn(*painter, *option, subControlRect(control, option, SC_SpinBoxUp, widget), 180);
        drawChevronIn(*painter, *option, subControlRect(control, option, SC_SpinBoxDown, widget), 0);
        return;
    }
    QProxyStyle::drawComplexControl(control, option, painter, widget);
}

QRect StudioStyle::subControlRect(ComplexControl control, const QStyleOptionComplex* option, SubControl part,
                                  const QWidget* widget) const {
    if (control == CC_ScrollBar) return scrollBarPart(*qstyleoption_cast<const QStyleOptionSlider*>(option), part);
    if (control == CC_ComboBox && (part == SC_ComboBoxArrow || part == SC_ComboBoxEditField)) {
        const QRect box = option->rect;
        const QRect arrow(box.right() - 23, box.top(), 20, box.height());
        const QRect field = box.adjusted(8, 2, -26, -2);
        return visualRect(option->direction, box, part == SC_ComboBoxArrow ? arrow : field);
    }
    if (control == CC_SpinBox && part != SC_SpinBoxFrame) {
        const QRect box = option->rect;
        const QRect up(box.right() - 20, box.top() + 2, 18, box.height() / 2 - 2);
        if (part == SC_SpinBoxUp) return up;
        if (part == SC_SpinBoxDown) return up.translated(0, box.height() / 2 - 2);
        return box.adjusted(8, 2, -24, -2);
    }
    return QProxyStyle::subControlRect(control, option, part, widget);
}

QSize StudioStyle::sizeFromContents(ContentsType type, const QStyleOption* option, const QSize& size,
                                    const QWidget* widget) const {
    const QSize fitted = QProxyStyle::sizeFromContents(type, option, size, widget);
    if (type == CT_ComboBox) return {fitted.width() + 8, 28};
    if (type == CT_SpinBox) return {fitted.width() + 8, 28};
    return fitted;
}

QIcon StudioStyle::standardIcon(StandardPixmap pixmap, const QStyleOption* option, const QWidget* widget) const {
    switch (pixmap) {
    case SP_MessageBoxInformation:
        return icon("info", IconRole::accent);
    case SP_MessageBoxQuestion:
        return icon("help", IconRole::accent);
    case SP_MessageBoxWarning:
        return icon("warning", IconRole::warning);
    case SP_MessageBoxCritical:
        return icon("error", IconRole::danger);
    case SP_TitleBarCloseButton:
    case SP_DockWidgetCloseButton:
    case SP_LineEditClearButton:
        return icon("close", IconRole::muted);
    case SP_DirIcon:
    case SP_DirOpenIcon:
    case SP_DirClosedIcon:
    case SP_DirHomeIcon:
    case SP_DesktopIcon:
    case SP_ComputerIcon:
    case SP_DriveHDIcon:
        return icon("folder");
    case SP_FileIcon:
        return icon("file");
    case SP_FileDialogNewFolder:
        return icon("plus");
    case SP_ArrowBack:
    case SP_ArrowLeft:
    case SP_FileDialogBack:
        return icon("chevron-right", IconRole::control, 180);
    case SP_ArrowForward:
    case SP_ArrowRight:
        return icon("chevron-right");
    case SP_ArrowUp:
    case SP_FileDialogToParent:
        return icon("chevron-down", IconRole::control, 180);
    case SP_ToolBarHorizontalExtensionButton:
        return icon("chevron-right");
    default:
        return QProxyStyle::standardIcon(pixmap, option, widget);
    }
}

} // namespace lumorph::studio
