// SPDX-License-Identifier: BSD-3-Clause
#include "AbortBehavior.h"

#include "Compatibility.h"
#include "OwnSources.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqProgressManager.h>
#include <pqServerManagerModel.h>

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkSMProxy.h>

#include <QAbstractButton>
#include <QCoreApplication>
#include <QMainWindow>
#include <QMouseEvent>
#include <QStatusBar>
#include <QTimer>
#include <QWindow>

#include <memory>

namespace
{
constexpr const char* AbortedText = "Aborted. Apply runs it again.";
} // namespace

//--------------------------------------------------------------------------------------------------
void AbortBehavior::Start()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    new AbortBehavior(core);
  }
}

//--------------------------------------------------------------------------------------------------
AbortBehavior::AbortBehavior(QObject* parent) : QObject(parent)
{
  pqApplicationCore* core = pqApplicationCore::instance();
  pqServerManagerModel* model = core->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    this->Watch(source);
  }
  this->connect(model, &pqServerManagerModel::sourceAdded, this, &AbortBehavior::Watch);
  this->connect(model, &pqServerManagerModel::sourceRemoved, this,
    [this](pqPipelineSource* source)
    {
      if (source == this->Aborted)
      {
        this->ClearMessage();
      }
    });
  this->connect(core->getProgressManager(), &pqProgressManager::abort, this,
    [this]()
    {
      if (this->Running)
      {
        this->Pressed = true;
        this->Running->SetAbortExecute(1);
      }
    });
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::Watch(pqPipelineSource* source)
{
  // There is none on the client's side if the server is another process.
  vtkObject* algorithm = vtkObject::SafeDownCast(source->getProxy()->GetClientSideObject());
  if (!algorithm || !OwnSources::IsOurs(source))
  {
    return;
  }
  this->Sources[algorithm] = source;
  algorithm->AddObserver(vtkCommand::StartEvent, this, &AbortBehavior::OnStart);
  algorithm->AddObserver(vtkCommand::ProgressEvent, this, &AbortBehavior::OnProgress);
  algorithm->AddObserver(vtkCommand::EndEvent, this, &AbortBehavior::OnEnd);
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::OnStart(vtkObject* algorithm, unsigned long, void*)
{
  pqProgressManager* progress = pqApplicationCore::instance()->getProgressManager();
  for (QObject* object : progress->nonBlockableObjects())
  {
    if (QAbstractButton* button = qobject_cast<QAbstractButton*>(object))
    {
      this->Button = button;
    }
  }
  this->ClearMessage();
  this->Running = vtkAlgorithm::SafeDownCast(algorithm);
  this->Pressed = false;
  this->SinceEvents.start();
  progress->setEnableAbort(true);
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::OnProgress(vtkObject* algorithm, unsigned long, void*)
{
  // As often as a user can see; less time would be spent on meshing otherwise.
  constexpr int interval = 100;
  if (algorithm != this->Running || this->SinceEvents.elapsed() < interval)
  {
    return;
  }
  pqProgressManager* progress = pqApplicationCore::instance()->getProgressManager();
  const bool unblocked = progress->unblockEvents(true);
  QCoreApplication::instance()->installEventFilter(this);
  QCoreApplication::processEvents();
  QCoreApplication::instance()->removeEventFilter(this);
  progress->unblockEvents(unblocked);
  this->SinceEvents.start();
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::OnEnd(vtkObject* algorithm, unsigned long, void*)
{
  if (algorithm != this->Running)
  {
    return;
  }
  pqApplicationCore::instance()->getProgressManager()->setEnableAbort(false);
  if (this->Pressed)
  {
    // What the pipeline remembers of the abort would run the filter again for the next picture.
    this->Running->SetAbortExecute(0);
    for (int port = 0; port < this->Running->GetNumberOfOutputPorts(); ++port)
    {
      if (this->Running->GetAbortOutput())
      {
        this->Running->GetOutputDataObject(port)->Initialize();
      }
      this->Running->GetOutputInformation(port)->Remove(vtkAlgorithm::ABORTED());
    }
    this->Running->SetAbortOutput(false);
    // The Apply that is at work would take back what is done here at once.
    const QPointer<pqPipelineSource> source = this->Sources.value(algorithm);
    const vtkSmartPointer<vtkAlgorithm> aborted = this->Running;
    QTimer::singleShot(0, this,
      [this, source, aborted]()
      {
        if (source)
        {
          this->OfferAgain(source, aborted);
        }
      });
  }
  this->Running = nullptr;
}

//--------------------------------------------------------------------------------------------------
QStatusBar* AbortBehavior::FindStatusBar() const
{
  QMainWindow* window = this->Button ? qobject_cast<QMainWindow*>(this->Button->window()) : nullptr;
  return window ? window->statusBar() : nullptr;
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::ClearMessage()
{
  QStatusBar* bar = this->FindStatusBar();
  if (bar && bar->currentMessage() == AbortedText)
  {
    bar->clearMessage();
  }
}

//--------------------------------------------------------------------------------------------------
void AbortBehavior::OfferAgain(pqPipelineSource* source, vtkAlgorithm* algorithm)
{
  // No warning: the window of those would lie upon the button in the next run.
  if (QStatusBar* bar = this->FindStatusBar())
  {
    // There is room for no more.
    bar->showMessage(AbortedText);
    this->Aborted = source;
  }
  source->setModifiedState(pqProxy::MODIFIED);
  const auto applied = std::make_shared<QMetaObject::Connection>();
  const vtkSmartPointer<vtkAlgorithm> kept = algorithm;
  *applied = this->connect(source, &pqProxy::modifiedStateChanged, this,
    [source, kept, applied]()
    {
      if (source->modifiedState() == pqProxy::UNMODIFIED)
      {
        QObject::disconnect(*applied);
        kept->Modified();
        source->getProxy()->MarkDirty(source->getProxy());
      }
    });
}

//--------------------------------------------------------------------------------------------------
bool AbortBehavior::eventFilter(QObject* receiver, QEvent* event)
{
  switch (event->type())
  {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    {
      // Qt hands it to the window first, then to the widget.
      const QPoint where = Compatibility::GetScreenPosition(static_cast<QMouseEvent*>(event));
      return !(this->Button &&
        (receiver == this->Button ||
          (qobject_cast<QWindow*>(receiver) &&
            this->Button->rect().contains(this->Button->mapFromGlobal(where)))));
    }
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
    case QEvent::Wheel:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::Shortcut:
    case QEvent::ShortcutOverride:
    case QEvent::ContextMenu:
    case QEvent::DragEnter:
    case QEvent::DragMove:
    case QEvent::Drop:
    case QEvent::TouchBegin:
    case QEvent::TouchUpdate:
    case QEvent::TouchEnd:
    // A timer that is not heard goes off again later.
    case QEvent::Timer:
      return true;
    case QEvent::Close:
      event->ignore();
      return true;
    default:
      return false;
  }
}
