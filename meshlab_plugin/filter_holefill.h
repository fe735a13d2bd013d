// SPDX-License-Identifier: GPL-3.0-or-later
/* The plugin: three MeshLab filters that use holefill through its C interface. */
#ifndef FILTER_HOLEFILL_H
#define FILTER_HOLEFILL_H

#include <QObject>

#include <common/plugins/interfaces/filter_plugin.h>

#include <map>
#include <string>

/* Names of filters and parameters must not change: scripts use them. */
class FilterHolefill : public QObject, public FilterPlugin {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
    Q_INTERFACES(FilterPlugin)

public:
    enum { FILL_HOLES, SELECT_RIMS, REPORT_HOLES };

    FilterHolefill();

    QString pluginName() const override;
    QString vendor() const override;
    QString filterName(ActionIDType filter) const override;
    QString pythonFilterName(ActionIDType filter) const override;
    QString filterInfo(ActionIDType filter) const override;
    FilterClass getClass(const QAction* action) const override;
    FilterArity filterArity(const QAction* action) const override;
    int getPreConditions(const QAction* action) const override;
    int postCondition(const QAction* action) const override;
    RichParameterList initParameterList(const QAction* action, const MeshModel& model) override;
    std::map<std::string, QVariant> applyFilter(const QAction* action, const RichParameterList& parameters,
                                                MeshDocument& document, unsigned int& postConditionMask,
                                                vcg::CallBackPos* callback) override;

private:
    using Values = std::map<std::string, QVariant>;

    Values fillHoles(const RichParameterList& parameters, MeshModel& model, unsigned int& mask,
                     vcg::CallBackPos* callback) const;
    Values selectRims(const RichParameterList& parameters, MeshModel& model) const;
    Values reportHoles(MeshModel& model) const;
};

#endif
