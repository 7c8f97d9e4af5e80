// A table whose cells change in place: rows are kept, so selection, focus and readers stay put.
import { h, setText } from "../core/dom";

export interface Column {
  label: string;
  unit?: string;
  /** Numbers stand to the right, in equal digits. */
  number?: boolean;
}

export interface LiveTable {
  root: HTMLElement;
  update: (rows: { head: string; cells: string[] }[]) => void;
}

export function liveTable(caption: string, head: string, columns: Column[], hideCaption = false): LiveTable {
  const body = h("tbody");
  const table = h(
    "table",
    { class: "data" },
    h("caption", { class: hideCaption ? "visually-hidden" : "" }, caption),
    h(
      "thead",
      null,
      h(
        "tr",
        null,
        h("th", { scope: "col" }, head),
        ...columns.map((column) =>
          h(
            "th",
            { scope: "col", class: column.number === false ? "" : "number" },
            column.label,
            column.unit ? h("span", { class: "unit" }, ` ${column.unit}`) : null,
          ),
        ),
      ),
    ),
    body,
  );
  const root = h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": caption },
    table,
  );

  const update: LiveTable["update"] = (rows) => {
    while (body.rows.length > rows.length) body.deleteRow(-1);
    rows.forEach((row, at) => {
      let line = body.rows[at];
      if (!line) {
        line = h("tr", null, h("th", { scope: "row" }));
        for (const column of columns)
          line.append(h("td", { class: column.number === false ? "" : "number" }));
        body.append(line);
      }
      const first = line.cells[0];
      if (first) setText(first, row.head);
      row.cells.forEach((text, k) => {
        const cell = line.cells[k + 1];
        if (cell) setText(cell, text);
      });
    });
  };
  return { root, update };
}
