# SPDX-License-Identifier: BSD-3-Clause
"""Every filter of the plugin explains itself, and the plugin offers what the classes offer.

Parses the server-manager XML, and compares it with the wrapped classes: each proxy and property
has a help text, real numbers with their unit, each class has a proxy, each option of a class has a
property with the same default and range, and output ports have names. What groups and decorators of the
panels speak of is there. Angles have their unit in the label, lengths in that of their group, and no
label changes the name that an option has in Python. ParaView's help file, if it was built, has a page and a picture for each
proxy, and the page index.html, which ParaView opens first.
"""

import glob
import os
import re
import sqlite3
import sys
import xml.etree.ElementTree as ElementTree

import conforming_delaunay
import paraview

UNITS = re.compile(r"\bunits?\b|degrees|micrometres|\bratio\b|part of|spacings|at these [xyz]|"
                   r"direction|sizes may grow|in seconds", re.IGNORECASE)
ANGLES = re.compile(r"in degrees|more degrees", re.IGNORECASE)
MODEL_UNITS = re.compile(r"in (square |cubic )?model units", re.IGNORECASE)
MICROMETRES = re.compile(r"in micrometres", re.IGNORECASE)
problems = []


def Check(condition, *words):
    if not condition:
        problems.append(" ".join(str(word) for word in words))


def HasText(element):
    return element is not None and len((element.text or "").strip()) > 20


def GetOptions(cls):
    """Names of the options a class adds to VTK's: those with both a Set and a Get method. The
    controller is no option in ParaView: it is that of the server."""
    instance = cls()
    methods = set(dir(cls))
    for base in cls.__mro__[1:]:
        methods -= set(dir(base))
    return {name[3:]: getattr(instance, "Get" + name[3:])()
            for name in methods
            if name.startswith("Set") and "Get" + name[3:] in methods and name != "SetController"}


def GetDomain(element, largest):
    """Smallest and largest value that the panel offers: of a list, or of a range."""
    values = [float(entry.get("value")) for entry in element.iter("Entry")]
    if values:
        return min(values), max(values)
    domain = element.find("DoubleRangeDomain")
    domain = element.find("IntRangeDomain") if domain is None else domain
    if domain is None or domain.get("min") is None:
        return None, None
    return float(domain.get("min")), float(domain.get("max", largest))


proxies = {}
for path in sorted(glob.glob(os.path.join(os.environ["CDM_PLUGIN_XML_DIR"], "*.xml"))):
    for kind in ("SourceProxy", "WriterProxy"):
        for proxy in ElementTree.parse(path).getroot().iter(kind):
            proxies[proxy.get("class")] = proxy
Check(proxies, "no server-manager XML found")

classes = {name: getattr(conforming_delaunay, name)
           for name in dir(conforming_delaunay) if name.startswith("vtk")}
Check(sorted(classes) == sorted(proxies), "classes", sorted(classes), "proxies", sorted(proxies))

for name, proxy in sorted(proxies.items()):
    documentation = proxy.find("Documentation")
    Check(HasText(documentation), name, "has no help text")
    for attribute in ("short_help", "long_help"):
        Check(documentation is not None and documentation.get(attribute), name, "lacks", attribute)
    Check(proxy.get("label", "").strip(), name, "has no label")
    menus = [entry.get("category") for entry in proxy.iter("ShowInMenu")]
    if proxy.tag == "WriterProxy":
        factory = proxy.find("Hints/WriterFactory")
        Check(factory is not None and factory.get("extensions"), name, "writes no kind of file")
    else:
        Check(menus == ["Conforming Delaunay"], name, "is in the menus", menus)

    properties = {}
    for child in proxy:
        if child.tag.endswith("Property"):
            properties[child.get("name")] = child
            Check(HasText(child.find("Documentation")), name, child.get("name"), "has no help text")

        if child.tag == "DoubleVectorProperty":
            Check(UNITS.search(child.find("Documentation").text), name, child.get("name"),
                  "has no unit in its help text")
        # Otherwise the value of a new filter would depend on whether its input is up to date, and a
        # script that asks for the default of the class would not get it.
        Check(child.find("BoundsDomain") is None or child.find("Hints/NoDefault") is not None,
              name, child.get("name"), "takes its default from its input")
    groups = {entry.get("name"): group.get("label")
              for group in proxy.iter("PropertyGroup") for entry in group.iter("Property")}
    for option, element in properties.items():
        label = element.get("label") or option
        text = " ".join((element.findtext("Documentation") or "").split())
        Check(paraview.make_name_valid(label) == option, name, option, "has another name in Python")
        Check(("°" in label) == bool(ANGLES.search(text)), name, option, "has the label", label)
        for unit, words in (("(model units)", MODEL_UNITS), ("(µm)", MICROMETRES)):
            Check(element.tag != "DoubleVectorProperty" or not words.search(text)
                  or unit in (groups.get(option) or ""),
                  name, option, "is in the group", groups.get(option))
    grouped = [entry.get("name") for entry in proxy.iter("Property")
               if entry.get("function") is None]
    Check(len(grouped) == len(set(grouped)), name, "has properties in two groups", grouped)
    deciders = [decorator.get("property") for decorator in proxy.iter("PropertyWidgetDecorator")
                if decorator.get("property")]
    for mentioned in {*grouped, *deciders}:
        Check(mentioned in properties, name, "has no property", mentioned)

    if name not in classes:
        continue
    options = GetOptions(classes[name])
    commands = {child.get("command") or "": child for child in properties.values()}
    for option, default in options.items():
        if "Set" + option not in commands:
            problems.append("%s has no property for Set%s" % (name, option))
            continue
        text = commands["Set" + option].get("default_values")
        if default is None:
            Check(text is None, name, option, "has no default, but in the plugin", text)
            continue
        values = default if isinstance(default, (tuple, list)) else [default]
        Check(text is not None and [float(word) for word in text.split()] ==
              [float(value) for value in values],
              name, option, "has the default", default, "and in the plugin", text)
    # The range of a class is that of its property's domain, in which no end stands for none. A domain
    # of the bounds of the input offers lengths.
    instance = classes[name]()
    for option in options:
        element = commands.get("Set" + option)
        if (element is None or not hasattr(instance, "Get%sMinValue" % option)
                or element.find("BoundsDomain") is not None):
            continue
        largest = 2**31 - 1 if element.tag == "IntVectorProperty" else 1e299
        low, high = GetDomain(element, largest)
        Check((low, high) == (getattr(instance, "Get%sMinValue" % option)(),
                              getattr(instance, "Get%sMaxValue" % option)()),
              name, option, "has in the plugin the range", low, high)
    # Tables are filled by commands that add a row, and emptied by another one.
    for command in [*commands, *(child.get("clean_command") for child in properties.values())]:
        Check(not command or hasattr(classes[name], command), name, "has no method", command)

    ports = [port.get("name") for port in proxy.iter("OutputPort")]
    Check(len(ports) == instance.GetNumberOfOutputPorts(), name, "has the output ports", ports)
    inputs = [int(child.get("port_index", 0)) for child in properties.values()
              if child.tag == "InputProperty"]
    Check(sorted(inputs) == list(range(instance.GetNumberOfInputPorts())),
          name, "has the input ports", inputs)

if os.environ.get("CDM_HELP_FILE"):
    # A Qt help file is a database.
    with sqlite3.connect(os.environ["CDM_HELP_FILE"]) as database:
        files = {row[0] for row in database.execute("SELECT Name FROM FileNameTable")}
    Check("index.html" in files, "the help file has no index.html")
    for path in sorted(glob.glob(os.path.join(os.environ["CDM_PLUGIN_XML_DIR"], "*.xml"))):
        for group in ElementTree.parse(path).getroot().iter("ProxyGroup"):
            for proxy in group:
                page = "%s.%s.html" % (group.get("name"), proxy.get("name"))
                picture = "Page%s.png" % proxy.get("name")
                Check({page, picture} <= files, "the help file lacks", page, "or", picture)

for problem in problems:
    print(problem)
print(len(proxies), "proxies,", len(problems), "problems")
sys.exit(1 if problems else 0)
