#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

/// Tables whose rows register themselves: the .cpp that defines a row adds it while the program
/// starts, so that no list of all rows needs an edit.
namespace catoptric {

/// Returns the rows of a table as they were registered. A program has one table of each type of
/// row. Call it only in the .cpp of the table.
template <typename Row>
std::vector<Row>& table_rows() {
    static std::vector<Row> rows;
    return rows;
}

template <typename Row, typename Key>
std::vector<Row> sorted_rows(const Key& key) {
    std::vector<Row> rows = table_rows<Row>();
    std::ranges::sort(rows, {}, [&](const Row& row) { return std::invoke(key, row); });
    return rows;
}

/// Returns the rows sorted by their members `order` and `name`.
template <typename Row>
std::vector<Row> sorted_rows() {
    return sorted_rows<Row>([](const Row& row) { return std::pair(row.order, row.name); });
}

} // namespace catoptric
