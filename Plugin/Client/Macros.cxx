// SPDX-License-Identifier: BSD-3-Clause
#include "Macros.h"

#include <pqApplicationCore.h>

#include <vtkPVPluginTracker.h>

#include <QAction>
#include <QDir>
#include <QFileInfo>
#include <QMetaObject>
#include <QObject>
#include <QPointer>
#include <QString>
#include <QTimer>
#include <QVariant>

#include <cstring>

namespace
{
/** The folder of this plugin's library; empty if it is not known. */
QString FindFolder()
{
  vtkPVPluginTracker* const tracker = vtkPVPluginTracker::GetInstance();
  for (unsigned int i = 0; i < tracker->GetNumberOfPlugins(); ++i)
  {
    const char* const name = tracker->GetPluginName(i);
    const char* const file = tracker->GetPluginFileName(i);
    if (name && file && std::strcmp(name, "ConformingDelaunay") == 0)
    {
      return QFileInfo(QString::fromLocal8Bit(file)).absolutePath();
    }
  }
  return {};
}

/** Adds them again when ParaView makes its list anew of the user's folder, as after an import. */
void KeepMacros(QObject* supervisor, const QString& folder);

void AddMacros(QObject* supervisor)
{
  const QString folder = FindFolder();
  if (folder.isEmpty())
  {
    return;
  }
  const QFileInfoList scripts =
    QDir(folder + "/Macros").entryInfoList({ "*.py" }, QDir::Files, QDir::Name);
  for (const QFileInfo& script : scripts)
  {
    QString name = script.completeBaseName().replace('_', ' ');
    name[0] = name[0].toUpper();
    QMetaObject::invokeMethod(
      supervisor, "addMacro", Q_ARG(QString, name), Q_ARG(QString, script.absoluteFilePath()));
  }
  KeepMacros(supervisor, folder);
}

void KeepMacros(QObject* supervisor, const QString& folder)
{
  const QPointer<QObject> list = supervisor;
  for (QAction* action : supervisor->findChildren<QAction*>())
  {
    if (action->data().toString().startsWith(folder))
    {
      // One of them is enough: they go together.
      QObject::connect(action, &QObject::destroyed, pqApplicationCore::instance(),
        [list]
        {
          QTimer::singleShot(0, pqApplicationCore::instance(),
            [list]
            {
              if (list)
              {
                AddMacros(list);
              }
            });
        });
      return;
    }
  }
}
} // namespace

//--------------------------------------------------------------------------------------------------
void Macros::Start()
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  if (!core)
  {
    return;
  }
  // The window makes the list of macros, perhaps after this plugin was loaded. By the name of its
  // class: ParaView may be without Python.
  QTimer::singleShot(0, core,
    [core]
    {
      for (QObject* child : core->findChildren<QObject*>())
      {
        if (child->inherits("pqPythonMacroSupervisor"))
        {
          AddMacros(child);
        }
      }
    });
}
