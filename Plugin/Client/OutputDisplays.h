// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputDisplays.h
 * @brief The part of the plugin for the ParaView GUI alone: outputs that were empty look as new ones.
 *
 * ParaView chooses how data are shown when it shows them first. If they are empty then, as a mesh
 * after an error, or the problems without one, it stays at that when they are there. After a failed
 * run it goes on showing what was there before.
 *
 * Method, for the outputs of this plugin's filters in a view, whenever its data are updated:
 *  1. what ParaView knows of the data is asked anew: a failed run, and data that are not shown,
 *     leave it as it was;
 *  2. a display whose output lost its cells asks for them again, and shows nothing;
 *  3. problems for which the filter's hints ask no view are shown while there is no mesh in its
 *     place, and hidden as soon as there is one. Between two such changes the user may choose;
 *  4. when an output gets its first cells, having been empty, it is colored by its array of regions,
 *     problems or faults, with the legend;
 *  5. problems and faults have thick lines and points, in front of the polygons that they are on.
 *     Without a mesh polygons with problems are surfaces, with one outlines, which do not hide it;
 *  6. while an output has no cells its legend is not shown, unless other displays in the view have
 *     the same colors. It comes back with the cells.
 */
#ifndef OutputDisplays_h
#define OutputDisplays_h

#include <QHash>
#include <QObject>

class pqDataRepresentation;
class pqView;

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
    /** Its legend was shown, and was hidden when its cells were gone. */
    bool LostLegend = false;
  };

  explicit OutputDisplays(QObject* parent);

  void Watch(pqView* view);
  void Update(pqView* view);
  /** Says if it changed. */
  bool UpdateDisplay(pqDataRepresentation* representation);
  /** Colors, lines and legend, steps 4 to 6. */
  static void SetLook(
    pqDataRepresentation* representation, const Display& known, const Display& before);

  QHash<QObject*, Display> Displays;
};
#endif
