// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Compatibility.h
 * @brief The differences between Qt 5 and Qt 6 that the parts for the GUI meet, in one place.
 */
#ifndef Compatibility_h
#define Compatibility_h

#include <QMouseEvent>
#include <QPoint>

namespace Compatibility
{
/** Where the mouse is on the screen. */
inline QPoint GetScreenPosition(const QMouseEvent* event)
{
#if QT_VERSION_MAJOR >= 6
  return event->globalPosition().toPoint();
#else
  return event->globalPos();
#endif
}
} // namespace Compatibility

#endif
