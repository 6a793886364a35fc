// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionColors.h
 * @brief The part of the plugin for the ParaView GUI alone: regions have colors and names.
 *
 * ParaView takes the cell array RegionId for a quantity: it spreads a color map over its range,
 * which is empty if there is one region. The same goes for the arrays ProblemKind, Fault and
 * RefinementFault.
 *
 * Method:
 *  1. a new color map of these arrays is one of categories, by ParaView's settings; those of
 *     problems and faults have their names. Color maps in states and in the user's own settings
 *     stay as they are;
 *  2. whenever visible data that are colored by it change, the legend is brought up to date: an
 *     entry for each region that has a name in the field array RegionNames or, if some have none,
 *     for each region that is there. These are the regions of the first data upstream, so that
 *     cutting data keeps their colors. Entries with other texts are the user's;
 *  3. of more than 30 regions none gets an entry, and the color map is spread over their range.
 */
#ifndef RegionColors_h
#define RegionColors_h

#include <QMap>
#include <QObject>
#include <QString>

class pqDataRepresentation;
class pqRepresentation;
class vtkSMProxy;

class RegionColors : public QObject
{
public:
  /** Starts to observe, if this process has the GUI; called when the plugin is loaded. */
  static void Start();

private:
  explicit RegionColors(QObject* parent);

  void Watch(pqRepresentation* representation);
  /** Brings the legend of its color map up to date. */
  void Update(pqDataRepresentation* representation);
  /** What the entries of a color map are to be; changes them, and says if it did. */
  bool SetTexts(vtkSMProxy* colors, QMap<int, QString> texts);

  /** Texts of legends that are from here, by region. */
  QMap<int, QString> Texts;
};
#endif
