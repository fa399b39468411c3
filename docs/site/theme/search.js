// Search over all sections of all pages, whose texts search_index.js holds. A section is found if it has every word.
"use strict";

const menu = document.querySelector(".menu");
if (matchMedia("(max-width: 800px)").matches) menu.open = false;

const input = document.querySelector(".search input"), list = document.querySelector(".search ol");
const entries = searchSections.map(section => ({...section, words: (section.page + " " + section.title + " " + section.text).toLowerCase()}));

function rank(entry, words) {
    const title = (entry.page + " " + entry.title).toLowerCase();
    let points = 0;
    for (const word of words) {
        if (!entry.words.includes(word)) return 0;
        points += (title.includes(word) ? 20 : 0) + Math.min(entry.words.split(word).length - 1, 10);
    }
    return points;
}

function cut(entry, word) {
    const at = entry.text.toLowerCase().indexOf(word), from = Math.max(0, at - 50);
    return (from > 0 ? "… " : "") + entry.text.slice(from, from + 160) + " …";
}

function show() {
    const words = input.value.toLowerCase().split(/\s+/).filter(word => word.length > 1);
    const found = entries.map(entry => [rank(entry, words), entry]).filter(([points]) => points > 0);
    found.sort((a, b) => b[0] - a[0]);
    list.replaceChildren(...found.slice(0, 20).map(([, entry]) => {
        const item = document.createElement("li"), link = document.createElement("a"), text = document.createElement("small");
        link.href = siteRoot + entry.location;
        link.textContent = entry.title === entry.page ? entry.title : entry.page + ": " + entry.title;
        text.textContent = cut(entry, words[0]);
        item.append(link, text);
        return item;
    }));
    if (words.length && !found.length) list.textContent = "No section has all these words.";
    list.hidden = words.length === 0;
}

input.addEventListener("input", show);
document.addEventListener("keydown", event => {
    if (event.key === "Escape") list.hidden = true;
    if (event.key === "/" && document.activeElement !== input) {
        event.preventDefault();
        input.focus();
    }
});
document.addEventListener("click", event => {
    if (!event.target.closest(".search")) list.hidden = true;
});
