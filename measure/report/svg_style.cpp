// The look of plots, and text within markup.
#include "measure/report/svg_plot.h"

namespace froth {

std::string plotStyle() {
  // Colours that stay apart for colour-blind readers, once for light and once for dark paper.
  return R"css(
svg.plot{--ink:#24292f;--soft:#6b7280;--grid:#e3e6ea;--paper:#ffffff;--c0:#0b63ce;--c1:#c2410c;--c2:#0f7b55;--c3:#8b3fc4;
--c4:#a16207;--c5:#0e7490;--c6:#be185d;--c7:#4b5563;font:11px system-ui,sans-serif;max-width:100%;height:auto}
@media(prefers-color-scheme:dark){svg.plot{--ink:#e6e8eb;--soft:#9aa4b1;--grid:#30363d;--paper:#14171b;--c0:#6cb0ff;
--c1:#ff9a5c;--c2:#4fd1a0;--c3:#cf9bff;--c4:#e5c454;--c5:#5fd4ea;--c6:#ff8cc0;--c7:#b4bcc6}}
svg.plot text{fill:var(--ink)}svg.plot .tick{fill:var(--soft)}svg.plot .title{font-weight:600;font-size:13px}
svg.plot .paper{fill:var(--paper)}
svg.plot .grid{stroke:var(--grid);fill:none}svg.plot .axis{stroke:var(--soft);fill:none}
svg.plot .label{paint-order:stroke;stroke:var(--paper);stroke-width:3px}
svg.plot .leader{stroke:var(--soft);stroke-width:.7;fill:none}
svg.plot .line{fill:none;stroke:var(--c);stroke-width:1.5}svg.plot .dashed{stroke-dasharray:6 4}
svg.plot .dotted{stroke-dasharray:1.5 3}
svg.plot .bar{fill:none;stroke:var(--c);stroke-width:1;opacity:.65}
svg.plot .mark{fill:var(--c);stroke:var(--paper);stroke-width:.8}
svg.plot .hollow{fill:var(--paper);stroke:var(--c);stroke-width:1.5}
svg.plot .ring{fill:none;stroke:var(--c);stroke-width:1.6}
svg.plot .c0{--c:var(--c0)}svg.plot .c1{--c:var(--c1)}svg.plot .c2{--c:var(--c2)}svg.plot .c3{--c:var(--c3)}
svg.plot .c4{--c:var(--c4)}svg.plot .c5{--c:var(--c5)}svg.plot .c6{--c:var(--c6)}svg.plot .c7{--c:var(--c7)}
svg.plot .cn{--c:var(--soft)}
)css";
}

std::string escapeMarkup(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '\n':
      case '\t':
        escaped += ' ';
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) escaped += c;
    }
  }
  return escaped;
}

}  // namespace froth
