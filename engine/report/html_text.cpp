#include "report/html.hpp"

#include "core/text.hpp"
#include "measure/picture_file.hpp"

#include <cstdint>

namespace catoptric::report {

namespace {

std::string encode_base64(std::string_view bytes) {
    constexpr char kBase64Digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0; // three bytes; missing bytes are 0
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 |
                    (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kBase64Digits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

} // namespace

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char c : escape_control_characters(text, "\n")) {
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&#39;"; break;
        case '\n': result += ' '; break; // a browser shows a line break as a space
        default: result += c;
        }
    }
    return result;
}

std::string make_png_data_uri(std::string_view png) {
    return "data:image/png;base64," + encode_base64(png);
}

const char* const kStyleSheet = R"(
:root { color-scheme: light dark; --paper: #fbfaf8; --card: #fff; --ink: #1c1b1a; --soft: #5d5954;
  --line: #e2ddd6; --accent: #9a3412; --tint: #fdf1e7; --other: #6f6a64; }
@media (prefers-color-scheme: dark) { :root { --paper: #151413; --card: #1e1c1b; --ink: #ece8e3;
  --soft: #aaa49c; --line: #35312e; --accent: #f0a36b; --tint: #2d2119; --other: #948d85; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; }
header, main, .main, nav { max-width: 76rem; margin: 0 auto; padding: 0 clamp(1rem, 4vw, 2.5rem); }
header { padding-top: 3rem; }
main, .main { padding-bottom: 4rem; }
h1 { font-size: clamp(1.8rem, 4vw, 2.6rem); line-height: 1.15; letter-spacing: -.02em;
  margin: 0 0 .4rem;
  overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; letter-spacing: -.01em; margin: 3.2rem 0 .9rem; }
h3 { font-size: 1rem; margin: 0; overflow-wrap: anywhere; }
p, li { max-width: 46rem; }
li { margin-bottom: .4rem; overflow-wrap: anywhere; }
ul { padding-left: 1.2rem; }
a { color: inherit; text-decoration-color: var(--accent); text-underline-offset: .2em; }
a:focus-visible, summary:focus-visible, .scroll:focus-visible { outline: 2px solid var(--accent);
  outline-offset: 2px; }
code { font: .86em/1.5 ui-monospace, "SF Mono", Menlo, Consolas, monospace;
  overflow-wrap: anywhere; }
.kicker { margin: 0 0 .5rem; color: var(--accent); font-weight: 600; font-size: .85rem; }
.lede { margin: 0; color: var(--soft); font-size: 1.1rem; }
.caution { margin: 1.6rem 0 0; padding: .2rem 1rem; border-left: 3px solid var(--accent);
  background: var(--tint); }
.caution ul { list-style: none; padding: 0; margin: .7rem 0; }
.note { color: var(--soft); font-size: .85rem; max-width: 60rem; }
.headline { display: grid; grid-template-columns: repeat(auto-fit, minmax(13rem, 1fr)); gap: 1px;
  margin: 2rem 0 0; background: var(--line); border: 1px solid var(--line); border-radius: .5rem;
  overflow: hidden; }
.headline div { background: var(--card); padding: .9rem 1.1rem; }
.headline dt, .facts dt { color: var(--soft); font-size: .85rem; }
.headline dd { margin: 0; font-size: 1.5rem; line-height: 1.3; font-variant-numeric: tabular-nums; }
.headline dd small { display: block; font-size: .85rem; color: var(--soft);
  overflow-wrap: anywhere; }
.facts { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: .3rem 1.5rem;
  margin: 0; }
.facts dd { margin: 0; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; border: 1px solid var(--line); border-radius: .5rem;
  background: var(--card); }
table { border-collapse: collapse; width: 100%; font-size: .82rem;
  font-variant-numeric: tabular-nums; }
th, td { padding: .42rem .7rem; text-align: right; white-space: nowrap;
  border-top: 1px solid var(--line); }
thead th { border-top: 0; color: var(--soft); font-weight: 600; vertical-align: bottom;
  white-space: normal; }
tbody th { font-weight: 500; }
.text { text-align: left; }
.words td.text { white-space: normal; }
.words td:nth-last-child(-n+3) { min-width: 14rem; }
tbody tr > :first-child, thead tr > :first-child { position: sticky; left: 0;
  background: var(--card); }
tr.front > *, tr.front > :first-child { background: var(--tint); }
.seed th:nth-child(6), .seed td:nth-child(6) { border-left: 2px solid var(--line); }
.plot { margin: 0; }
.plot svg { display: block; width: 100%; min-width: 40rem; height: auto; }
.panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr));
  gap: 1.25rem; }
.panels figure { background: var(--card); border: 1px solid var(--line); border-radius: .5rem;
  padding: .8rem; min-width: 0; }
.panels svg { display: block; width: 100%; height: auto; }
svg text { font: 11px system-ui, sans-serif; fill: var(--soft);
  font-variant-numeric: tabular-nums; }
svg .label { fill: var(--ink); stroke: var(--card); stroke-width: 3; stroke-linejoin: round;
  paint-order: stroke; }
svg .grid { stroke: var(--line); }
svg .lane { fill: var(--tint); }
svg .step { fill: none; stroke: var(--accent); stroke-width: 1.5; stroke-dasharray: 5 4; }
svg .noise { fill: none; stroke: var(--other); stroke-width: 1; stroke-dasharray: 2 4; }
svg .mark.hidden { fill-opacity: .25; }
svg .interval { fill: none; stroke: var(--other); stroke-width: 1.5; }
svg .line { fill: none; stroke: var(--accent); stroke-width: 1.5; stroke-linejoin: round; }
svg .mark { fill: var(--card); stroke: var(--other); stroke-width: 1.5; }
svg .mark.front { fill: var(--accent); stroke: var(--accent); }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: .82rem; margin-top: .35rem; }
img { display: block; width: 100%; height: auto; background: #000; border-radius: .25rem; }
.reference { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 18rem), 1fr));
  gap: 1.5rem; align-items: end; max-width: 54rem; }
.scale { height: .8rem; border-radius: .25rem; border: 1px solid var(--line); }
.ends { display: flex; justify-content: space-between; font-size: .82rem; color: var(--soft); }
.legend { display: flex; flex-wrap: wrap; gap: .2rem 1rem; list-style: none; padding: 0;
  margin: .8rem 0 0; font-size: .82rem; color: var(--soft); }
.legend span { display: inline-block; width: .8rem; height: .8rem; margin-right: .4rem;
  border: 1px solid var(--line); vertical-align: -.1rem; }
.rows { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 31rem), 1fr));
  gap: 1.25rem; margin-top: 1.5rem; }
article { background: var(--card); border: 1px solid var(--line); border-radius: .5rem;
  padding: 1rem;
  scroll-margin-top: 1rem; min-width: 0; }
article:target { border-color: var(--accent); }
.title { display: flex; flex-wrap: wrap; gap: .3rem .6rem; align-items: baseline;
  margin-bottom: .7rem; }
.badge { font-size: .75rem; padding: .05rem .5rem; border-radius: 1rem;
  border: 1px solid var(--accent);
  color: var(--accent); }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: .6rem; }
.numbers { display: grid; grid-template-columns: repeat(auto-fill, minmax(6.5rem, 1fr));
  gap: .5rem 1rem;
  margin: .9rem 0 .6rem; }
.numbers dt { color: var(--soft); font-size: .78rem; }
.numbers dd { margin: 0; font-variant-numeric: tabular-nums; }
details { font-size: .85rem; }
summary { cursor: pointer; color: var(--soft); }
details table { width: auto; margin-top: .4rem; }
@media print { .rows article { break-inside: avoid; } }
)";

} // namespace catoptric::report
