#include "core/search/search_file.h"

#include <bit>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = std::size_t{64} << 20U;

class Fingerprint {
public:
    void add(std::uint64_t value) {
        for (int byte = 0; byte < 8; ++byte) {
            value_ ^= (value >> (8U * static_cast<unsigned>(byte))) & 0xFFU;
            value_ *= 0x100000001B3ULL;
        }
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const glm::dvec2& p) { add(p.x), add(p.y); }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

nlohmann::json designJson(const ScoredDesign& design) {
    return {
        {"cost", design.score.cost}, {"fit", design.score.fit}, {"gain", design.score.gain}, {"point", design.point}};
}

/// Reads what `writeSearchState` has written; anything else is a DataError.
class StateReader {
public:
    StateReader(std::filesystem::path file, const nlohmann::json& json) : file_(std::move(file)), json_(json) {}

    [[nodiscard]] SearchIdentity identity() const {
        SearchIdentity identity;
        identity.rig = get<std::string>(json_, "rig");
        identity.sheet = get<std::uint64_t>(json_, "sheet");
        identity.targets = get<std::uint64_t>(json_, "targets");
        identity.seed = get<std::uint64_t>(json_, "seed");
        identity.population = get<int>(json_, "population");
        identity.mostServos = get<std::size_t>(json_, "mostServos");
        identity.cost = get<std::string>(json_, "cost") == "price" ? SearchCost::price : SearchCost::servos;
        return identity;
    }

    [[nodiscard]] SearchState state(const SearchIdentity& identity) const {
        SearchState state;
        state.seed = identity.seed;
        state.dimension = identity.mostServos * SheetDesigns::kGenes;
        state.generation = get<int>(json_, "generation");
        state.evaluations = get<std::uint64_t>(json_, "evaluations");
        if (state.generation < 0) fail();
        for (const nlohmann::json& design : list(json_, "designs")) state.population.push_back(read(design, state));
        if (state.population.size() != static_cast<std::size_t>(identity.population)) fail();
        for (const nlohmann::json& line : list(json_, "lines")) {
            state.lines.push_back(read(line, state));
            if (!(state.lines.back().point[SheetDesigns::kThere] >= 0.5)) fail();
        }
        for (const nlohmann::json& kept : list(json_, "best"))
            for (const nlohmann::json& design : list(kept, "designs"))
                state.best[get<std::int64_t>(kept, "hundredths")].push_back(read(design, state));
        if (state.best.empty()) fail();
        return state;
    }

    [[noreturn]] void fail() const {
        throw DataError(file_.string(), "it is no state of a search", "take it away, and the search begins anew");
    }

private:
    template <typename Value> Value get(const nlohmann::json& from, const char* key) const {
        const auto found = from.find(key);
        if (!from.is_object() || found == from.end()) fail();
        try {
            return found->get<Value>();
        } catch (const nlohmann::json::exception&) {
            fail();
        }
    }
    const nlohmann::json& list(const nlohmann::json& from, const char* key) const {
        const auto found = from.find(key);
        if (!from.is_object() || found == from.end() || !found->is_array()) fail();
        return *found;
    }
    [[nodiscard]] ScoredDesign read(const nlohmann::json& json, const SearchState& state) const {
        ScoredDesign design{get<DesignPoint>(json, "point"),
                            {get<double>(json, "cost"), get<double>(json, "fit"), get<double>(json, "gain")}};
        bool sound = design.point.size() == state.dimension && design.score.cost >= 0.0 && design.score.fit >= 0.0 &&
                     design.score.fit <= 1.0 && std::isfinite(design.score.cost);
        for (const double gene : design.point) sound = sound && gene >= 0.0 && gene <= 1.0;
        if (!sound) fail();
        return design;
    }

    std::filesystem::path file_;
    const nlohmann::json& json_;
};

void requireSame(const std::filesystem::path& folder, const SearchIdentity& there, const SearchIdentity& now) {
    const char* remedy = "choose another folder, or the settings it was begun with";
    if (there.sheet != now.sheet || there.rig != now.rig)
        throw InvalidInput(folder.string(), "it holds the search of another rig, " + inQuotes(there.rig),
                           "choose another folder");
    if (there.targets != now.targets)
        throw InvalidInput(folder.string(), "it holds a search for other targets", "choose another folder");
    if (there.seed != now.seed)
        throw InvalidInput(folder.string(), "it holds a search of seed " + std::to_string(there.seed), remedy);
    if (there.population != now.population)
        throw InvalidInput(folder.string(),
                           "it holds a search with a population of " + std::to_string(there.population), remedy);
    if (there.mostServos != now.mostServos)
        throw InvalidInput(folder.string(),
                           "it holds a search for up to " + std::to_string(there.mostServos) + " servos", remedy);
    if (there.cost != now.cost) throw InvalidInput(folder.string(), "it holds a search for another cost", remedy);
}

} // namespace

std::uint64_t fingerprint(const SheetDevice& sheet) {
    Fingerprint print;
    for (const glm::dvec2& p : sheet.outline) print.add(p);
    for (const double measure : {sheet.thickness, sheet.housing, sheet.arc}) print.add(measure);
    for (const BendLine& line : sheet.bends) print.add(line.from), print.add(line.to);
    return print.value();
}

std::uint64_t fingerprint(std::span<const Target> targets) {
    Fingerprint print;
    for (const Target& target : targets) {
        print.add(static_cast<std::uint64_t>(target.mesh.triangles.size()));
        for (const glm::vec3& p : target.mesh.positions)
            for (int k = 0; k < 3; ++k) print.add(static_cast<double>(p[k]));
    }
    return print.value();
}

std::filesystem::path searchStateFile(const std::filesystem::path& folder) { return folder / "search.json"; }

void writeSearchState(const std::filesystem::path& folder, const SearchIdentity& identity, const SearchState& state) {
    nlohmann::json designs = nlohmann::json::array();
    for (const ScoredDesign& design : state.population) designs.push_back(designJson(design));
    nlohmann::json lines = nlohmann::json::array();
    for (const ScoredDesign& line : state.lines) lines.push_back(designJson(line));
    nlohmann::json best = nlohmann::json::array();
    for (const auto& [cost, kept] : state.best) {
        nlohmann::json list = nlohmann::json::array();
        for (const ScoredDesign& design : kept) list.push_back(designJson(design));
        best.push_back({{"hundredths", cost}, {"designs", list}});
    }
    const nlohmann::json json = {{"lumorphSearch", kVersion},
                                 {"rig", identity.rig},
                                 {"sheet", identity.sheet},
                                 {"targets", identity.targets},
                                 {"seed", identity.seed},
                                 {"population", identity.population},
                                 {"mostServos", identity.mostServos},
                                 {"cost", identity.cost == SearchCost::price ? "price" : "servos"},
                                 {"generation", state.generation},
                                 {"evaluations", state.evaluations},
                                 {"designs", designs},
                                 {"lines", lines},
                                 {"best", best}};
    const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    writeFileAtomically(searchStateFile(folder), std::as_bytes(std::span(text)));
}

std::optional<SearchState> readSearchState(const std::filesystem::path& folder, const SearchIdentity& identity) {
    const std::filesystem::path file = searchStateFile(folder);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::nullopt;
    const std::vector<std::byte> bytes = readFile(file, kMostBytes);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const nlohmann::json json =
        jsonProblem(text).empty() ? nlohmann::json::parse(text, nullptr, false) : nlohmann::json();
    const StateReader reader(file, json);
    if (!json.is_object() || json.value("lumorphSearch", nlohmann::json()) != kVersion) reader.fail();
    const SearchIdentity there = reader.identity();
    requireSame(folder, there, identity);
    return reader.state(there);
}

} // namespace lumorph
