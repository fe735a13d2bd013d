#include "mesh_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace judge {

namespace {

enum class Scalar { I8, U8, I16, U16, I32, U32, F32, F64 };

Scalar parse_scalar(const std::string& name) {
    if (name == "char" || name == "int8") return Scalar::I8;
    if (name == "uchar" || name == "uint8") return Scalar::U8;
    if (name == "short" || name == "int16") return Scalar::I16;
    if (name == "ushort" || name == "uint16") return Scalar::U16;
    if (name == "int" || name == "int32") return Scalar::I32;
    if (name == "uint" || name == "uint32") return Scalar::U32;
    if (name == "float" || name == "float32") return Scalar::F32;
    if (name == "double" || name == "float64") return Scalar::F64;
    throw std::runtime_error("unknown PLY type " + name);
}

std::size_t size_of(Scalar type) {
    switch (type) {
        case Scalar::I8:
        case Scalar::U8: return 1;
        case Scalar::I16:
        case Scalar::U16: return 2;
        case Scalar::I32:
        case Scalar::U32:
        case Scalar::F32: return 4;
        case Scalar::F64: return 8;
    }
    return 0;
}

class Reader {
public:
    explicit Reader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

    std::string line() {
        std::string text;
        while (at_ < bytes_.size() && bytes_[at_] != '\n') text.push_back(bytes_[at_++]);
        if (at_ == bytes_.size()) throw std::runtime_error("the PLY header has no end");
        ++at_;
        if (!text.empty() && text.back() == '\r') text.pop_back();
        return text;
    }

    double scalar(Scalar type) {
        switch (type) {
            case Scalar::I8: return raw<std::int8_t>();
            case Scalar::U8: return raw<std::uint8_t>();
            case Scalar::I16: return raw<std::int16_t>();
            case Scalar::U16: return raw<std::uint16_t>();
            case Scalar::I32: return raw<std::int32_t>();
            case Scalar::U32: return raw<std::uint32_t>();
            case Scalar::F32: return raw<float>();
            case Scalar::F64: return raw<double>();
        }
        return 0.0;
    }

    void skip(std::size_t n) {
        if (n > bytes_.size() - at_) throw std::runtime_error("the PLY file is cut short");
        at_ += n;
    }

private:
    template <typename T>
    double raw() {
        T value;
        const std::size_t from = at_;
        skip(sizeof(T));
        std::memcpy(&value, bytes_.data() + from, sizeof(T));
        return static_cast<double>(value);
    }

    std::vector<char> bytes_;
    std::size_t at_ = 0;
};

struct Property {
    std::string name;
    bool list = false;
    Scalar count_type = Scalar::U8, type = Scalar::F64;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

std::vector<Element> read_header(Reader& reader) {
    if (reader.line() != "ply") throw std::runtime_error("not a PLY file");
    std::vector<Element> elements;
    for (;;) {
        std::istringstream words(reader.line());
        std::string keyword, first;
        words >> keyword;
        if (keyword == "end_header") return elements;
        if (keyword == "format") {
            words >> first;
            if (first != "binary_little_endian")
                throw std::runtime_error("only binary little endian PLY is read, not " + first);
        } else if (keyword == "element") {
            Element element;
            words >> element.name >> element.count;
            elements.push_back(element);
        } else if (keyword == "property") {
            if (elements.empty()) throw std::runtime_error("a PLY property before any element");
            Property property;
            words >> first;
            if (first == "list") {
                std::string count_type;
                words >> count_type >> first;
                property.list = true;
                property.count_type = parse_scalar(count_type);
            }
            property.type = parse_scalar(first);
            words >> property.name;
            elements.back().properties.push_back(property);
        }
    }
}

}  // namespace

Arrays read_ply(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot open " + path);
    Reader reader({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
    Arrays arrays;
    for (const Element& element : read_header(reader)) {
        const bool vertices = element.name == "vertex", faces = element.name == "face";
        if (vertices) arrays.points.reserve(element.count);
        if (faces) arrays.triangles.reserve(element.count);
        for (std::size_t row = 0; row < element.count; ++row) {
            std::array<double, 3> point{};
            for (const Property& property : element.properties) {
                if (!property.list) {
                    const double value = reader.scalar(property.type);
                    if (vertices && property.name.size() == 1 && property.name[0] >= 'x' &&
                        property.name[0] <= 'z')
                        point[static_cast<std::size_t>(property.name[0] - 'x')] = value;
                    continue;
                }
                const auto n = static_cast<std::size_t>(reader.scalar(property.count_type));
                if (!faces || property.name.rfind("vertex_ind", 0) != 0) {
                    reader.skip(n * size_of(property.type));
                    continue;
                }
                if (n != 3) throw std::runtime_error("a face that is not a triangle");
                Triangle triangle;
                for (std::uint32_t& v : triangle) {
                    const double index = reader.scalar(property.type);
                    if (index < 0.0 || index >= static_cast<double>(arrays.points.size()))
                        throw std::runtime_error("a face names a vertex that does not exist");
                    v = static_cast<std::uint32_t>(index);
                }
                arrays.triangles.push_back(triangle);
            }
            if (vertices) arrays.points.push_back(point);
        }
    }
    return arrays;
}

void write_ply(const std::string& path, const Arrays& arrays) {
    std::ofstream file(path, std::ios::binary);
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << arrays.points.size()
         << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
         << arrays.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& p : arrays.points)
        file.write(reinterpret_cast<const char*>(p.data()), sizeof p);
    for (const Triangle& t : arrays.triangles) {
        file.put(3);
        file.write(reinterpret_cast<const char*>(t.data()), sizeof t);
    }
    file.close();
    if (!file) throw std::runtime_error("cannot write " + path);
}

Arrays read_off(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path);
    std::stringstream text;
    for (std::string line; std::getline(file, line);) text << line.substr(0, line.find('#')) << '\n';
    std::string keyword;
    std::size_t points = 0, faces = 0, edges = 0;
    text >> keyword >> points >> faces >> edges;
    if (keyword != "OFF" || !text) throw std::runtime_error("not an OFF file: " + path);
    Arrays arrays;
    arrays.points.resize(points);
    for (Point& p : arrays.points) text >> p[0] >> p[1] >> p[2];
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t n = 0;
        text >> n;
        std::vector<std::uint32_t> corners(n < 1000 ? n : 0);
        for (std::uint32_t& v : corners) {
            text >> v;
            if (v >= points) throw std::runtime_error("a face names a vertex that does not exist");
        }
        // Colors may follow.
        std::string rest;
        std::getline(text, rest);
        for (std::size_t k = 2; k < corners.size(); ++k)
            arrays.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
    if (!text) throw std::runtime_error("the OFF file is cut short: " + path);
    return arrays;
}

}  // namespace judge
