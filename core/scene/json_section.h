#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// Reading the JSON of a project file or a device profile. Private to the sources that do.
namespace lumorph {

/// One JSON object of a project and where it stands. What has been read is taken out, so that the rest is what this
/// version does not know. Whatever is not as it should be throws DataError naming the file, the key and the remedy;
/// a key that is missing leaves the value as it is.
class JsonSection {
public:
    JsonSection(nlohmann::json& object, std::string prefix, const std::string& file)
        : object_(&object), prefix_(std::move(prefix)), file_(&file) {}

    [[nodiscard]] bool has(const std::string& key) const { return find(key) != nullptr; }
    void text(const std::string& key, std::string& value);
    /// A text that may stand for an asset: one that stays in the project's folder, a resource, or none.
    void asset(const std::string& key, std::string& value);
    void flag(const std::string& key, bool& value);
    void number(const std::string& key, double& value, double min, double max);
    void wholeNumber(const std::string& key, int& value, int min, int max);
    /// Numbers; `most` of them where it is to be exactly so many.
    void numbers(const std::string& key, std::vector<double>& values, double min, double max, std::size_t most,
                 bool exactly = false);
    /// At most `most` texts.
    void texts(const std::string& key, std::vector<std::string>& values, std::size_t most);
    /// Reads what lies under `key`; of that object only what is not known stays.
    template <typename Read> void section(const std::string& key, Read read) {
        if (!has(key)) return;
        nlohmann::json& inner = (*object_)[key];
        if (!inner.is_object()) refuse(key, "is not an object", "write it in { }, or remove it");
        read(JsonSection(inner, prefix_ + key + ".", *file_));
        if (inner.empty()) object_->erase(key);
    }
    /// Reads a list of at most `most` objects one by one; what is not known of them is lost.
    template <typename Read> void sections(const std::string& key, std::size_t most, Read read) {
        if (!has(key)) return;
        nlohmann::json& list = (*object_)[key];
        refuseNoList(key, list, most);
        std::size_t index = 0;
        for (nlohmann::json& element : list) {
            const std::string name = key + "[" + std::to_string(index++) + "]";
            if (!element.is_object()) refuse(name, "is not an object", "write it in { }, or remove it");
            read(JsonSection(element, prefix_ + name + ".", *file_));
        }
        object_->erase(key);
    }
    [[noreturn]] void refuse(const std::string& key, const std::string& why, const std::string& remedy) const;

private:
    [[nodiscard]] const nlohmann::json* find(const std::string& key) const;
    [[nodiscard]] double numberIn(const nlohmann::json& value, const std::string& key, double min, double max) const;
    void refuseNoList(const std::string& key, const nlohmann::json& value, std::size_t most) const;

    nlohmann::json* object_;
    std::string prefix_;
    const std::string* file_;
};

} // namespace lumorph
