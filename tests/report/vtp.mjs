// Reads the VTP files of a result folder: raw appended data with 64-bit sizes, as the library writes them.
import { readFileSync } from "node:fs";

const kinds = { Float64: [8, "getFloat64"], Int64: [8, "getBigInt64"], Int32: [4, "getInt32"] };

// { points: {name: numbers}, cells: {...}, Points, triangles, lines, lineCount }; arrays of several components stay flat.
export function readVtp(path) {
  const bytes = readFileSync(path), begin = bytes.indexOf("<AppendedData"), first = bytes.indexOf("_", begin) + 1;
  const head = bytes.subarray(0, begin).toString();
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const arrays = section => {
    const found = {};
    const text = head.slice(head.indexOf(`<${section}`), head.indexOf(`</${section}>`));
    for (const [tag] of text.matchAll(/<DataArray [^>]*>/g)) {
      const of = name => new RegExp(`${name}="([^"]*)"`).exec(tag)?.[1];
      const [size, get] = kinds[of("type")], at = first + Number(of("offset"));
      const count = Number(view.getBigUint64(at, true)) / size;
      found[of("Name")] = Array.from({ length: count }, (_, k) => Number(view[get](at + 8 + k * size, true)));
    }
    return found;
  };
  return { points: arrays("PointData"), cells: arrays("CellData"), Points: arrays("Points").Points,
           triangles: arrays("Polys").connectivity, lines: arrays("Lines").connectivity, lineCount: Number(/NumberOfLines="(\d+)"/.exec(head)[1]) };
}
