// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AbortBehavior.h
 * @brief The part of the plugin for the ParaView GUI alone: its Abort button ends our filters.
 *
 * ParaView 5.11 has an Abort button beside its progress bar, but never enables it, and does not
 * look at the mouse while a filter runs.
 *
 * Method:
 *  1. the sources of this plugin in the pipeline browser are observed, unless they are on a remote
 *     server: at work, that does not listen to its client;
 *  2. while one of them runs, the button is enabled, and at its progress events Qt handles what has
 *     arrived. Of the user's input only that for the button gets through, and no timer goes off:
 *     nothing else may change or draw the pipeline that is at work;
 *  3. a press sets the filter's flag AbortExecute. The run ends soon; then the flag is taken back,
 *     a message says what happened until the next run, or until the filter is deleted, and Apply can
 *     be pressed: it runs the filter again.
 */
#ifndef AbortBehavior_h
#define AbortBehavior_h

#include <QElapsedTimer>
#include <QMap>
#include <QObject>
#include <QPointer>

#include <vtkSmartPointer.h>

class QStatusBar;
class QWidget;
class pqPipelineSource;
class vtkAlgorithm;
class vtkObject;

class AbortBehavior : public QObject
{
public:
  /** Starts to observe, if this process has the GUI; called when the plugin is loaded. */
  static void Start();

  bool eventFilter(QObject* receiver, QEvent* event) override;

private:
  explicit AbortBehavior(QObject* parent);

  void Watch(pqPipelineSource* source);
  void OnStart(vtkObject* algorithm, unsigned long, void*);
  void OnProgress(vtkObject* algorithm, unsigned long, void*);
  void OnEnd(vtkObject* algorithm, unsigned long, void*);
  /**
   * Says that the run was aborted, and lets Apply run the filter again, its options as they are.
   */
  void OfferAgain(pqPipelineSource* source, vtkAlgorithm* algorithm);

  /** That of the window with the button; null without one. */
  QStatusBar* FindStatusBar() const;
  /** Takes the message back if it is still there. */
  void ClearMessage();

  QMap<vtkObject*, QPointer<pqPipelineSource>> Sources;
  vtkSmartPointer<vtkAlgorithm> Running;
  /** The source that the message is about. */
  QPointer<pqPipelineSource> Aborted;
  bool Pressed = false;
  QElapsedTimer SinceEvents;
  QPointer<QWidget> Button;
};
#endif
