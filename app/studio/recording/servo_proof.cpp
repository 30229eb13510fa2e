#include "app/studio/recording/servo_proof.h"

#include <span>

#include <QCoreApplication>
#include <QLocale>

#include "devices/controllers/servo_trace.h"

namespace lumorph::studio {
namespace {

/// Each link's trace begins so.
constexpr auto kBegin = "machine";

std::vector<std::vector<ServoTraceRow>> tracesOf(const std::vector<ServoRow>& rows) {
    std::vector<std::vector<ServoTraceRow>> traces;
    for (const ServoRow& row : rows) {
        if (traces.empty() || row.kind == kBegin) traces.emplace_back();
        traces.back().push_back({row.time, row.kind, row.bytes});
    }
    return traces;
}

QString tr(const char* text) { return QCoreApplication::translate("ServoProof", text); }

} // namespace

ServoProof proveServos(const std::vector<ServoRow>& rows, const Progress& progress) {
    ServoProof proof;
    const auto traces = tracesOf(rows);
    for (const auto& trace : traces) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(proof.links) / static_cast<double>(traces.size()), "running it again");
        const TraceCheck check = checkTrace(trace);
        ++proof.links;
        proof.bytes += check.bytesSent;
        if (!check.difference) continue;
        proof.difference = tr("at %1 s (row %2): %3")
                               .arg(1e-6 * static_cast<double>(check.difference->time.count()), 0, 'f', 3)
                               .arg(check.difference->row + 1)
                               .arg(QString::fromStdString(check.difference->text));
        break;
    }
    return proof;
}

QString proofText(const ServoProof& proof) {
    if (!proof.difference.isEmpty()) return tr("The servo bytes differ %1").arg(proof.difference);
    if (proof.links == 0) return tr("No servos were connected, so there is nothing to compare");
    return tr("%1 bytes to the servos equal bit for bit").arg(QLocale::c().toString(proof.bytes));
}

} // namespace lumorph::studio
