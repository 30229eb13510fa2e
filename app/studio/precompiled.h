#pragma once

// Qt headers that nearly every file of the studio needs. No Qt GL header: epoxy has to come before those.
#include <QAction>
#include <QApplication>
#include <QBoxLayout>
#include <QColor>
#include <QEvent>
#include <QIcon>
#include <QLabel>
#include <QObject>
#include <QPainter>
#include <QPushButton>
#include <QString>
#include <QTimer>
#include <QWidget>
