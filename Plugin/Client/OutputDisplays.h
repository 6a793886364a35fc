// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputDisplays.h
 * @brief The part of the plugin for the ParaView GUI alone: outputs that were empty look as new ones.
 *
 * ParaView chooses how data are shown when it shows them first. If they are empty then, as a mesh
 * after an error, or the problems without one, it stays at that when they are there.
 *
 * Method, for outputs of this plugin's filters:
 *  1. when one gets its first cells, having been empty, it is colored by its array of regions,
 *     problems or faults, with the legend;
 *  2. problems and faults have thick lines and points, in front of the polygons that they are on.
 *     Without a mesh polygons with problems are surfaces, with one outlines, which do not hide it;
 *  3. while there are no problems or faults their legend is not shown.
 */
#ifndef OutputDisplays_h
#define OutputDisplays_h

#include <QHash>
#include <QObject>

class pqDataRepresentation;
class pqRepresentation;

class OutputDisplays : public QObject
{
public:
  /** Starts to observe, if this process has the GUI; called when the plugin is loaded. */
  static void Start();

private:
  /** What is known of a display. */
  struct Display
  {
    bool WasEmpty = false;
    bool HasCells = false;
    bool HasMesh = false;
  };

  explicit OutputDisplays(QObject* parent);

  void Watch(pqRepresentation* representation);
  void Update(pqDataRepresentation* representation);

  QHash<QObject*, Display> Displays;
};
#endif
