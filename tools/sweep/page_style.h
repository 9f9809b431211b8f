// The looks of the report: light and dark by what the reader's system prefers, one column on phones.
#pragma once

namespace acdf::tools {

constexpr const char* report_style = R"(
:root{color-scheme:light dark;--page:#f6f7f9;--card:#fff;--ink:#1b1f24;--soft:#59636e;--rule:#d5dae0;--grid:#e6e9ed;
--key:#0b62a8;--keybg:#e8f2fb;--f0:#0b62a8;--f1:#c75300;--f2:#0a7d58;--f3:#a3478c;--f4:#8a6d00;--baseline:#454c54}
@media (prefers-color-scheme:dark){:root{--page:#11151a;--card:#1a2027;--ink:#e8ecf1;--soft:#a2adb9;--rule:#36404b;
--grid:#29313a;--key:#6fb6f2;--keybg:#152737;--f0:#6fb6f2;--f1:#f09050;--f2:#4fc79a;--f3:#dd8bc6;--f4:#d9bb4a;
--baseline:#c3ccd6}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif}
header,main,footer{max-width:1200px;margin:0 auto;padding:0 20px}
header{padding-top:28px}
h1{font-size:1.9rem;line-height:1.2;margin:0;overflow-wrap:anywhere}
h2{font-size:1.25rem;margin:44px 0 8px}
h3{font-size:1rem;margin:0}
p{margin:8px 0}
.kicker,.soft,figcaption,footer{color:var(--soft)}
.kicker{margin:0;font-size:.85rem;letter-spacing:.04em}
.advice{background:var(--keybg);border-left:5px solid var(--key);border-radius:6px;padding:18px 22px;margin-top:22px}
.lead{font-size:1.35rem;line-height:1.35;margin:0}
.facts{display:grid;grid-template-columns:repeat(auto-fit,minmax(170px,1fr));gap:12px 24px;margin:18px 0}
.facts dt{color:var(--soft);font-size:.85rem}
.facts dd{margin:0;font-size:1.25rem;font-weight:600;font-variant-numeric:tabular-nums}
.facts dd small{display:block;font-size:.8rem;font-weight:400;color:var(--soft)}
pre{background:var(--card);border:1px solid var(--rule);border-radius:6px;padding:10px 12px;margin:6px 0;
white-space:pre-wrap;overflow-wrap:anywhere;font:.9rem/1.45 ui-monospace,Menlo,Consolas,monospace}
.rule{font-size:.9rem;color:var(--soft);margin-bottom:0}
.legend{display:grid;grid-template-columns:repeat(auto-fill,minmax(230px,1fr));gap:2px 18px;list-style:none;
padding:0;margin:10px 0 14px;font-size:.92rem}
.legend li{display:flex;align-items:center;gap:8px}
.mark{width:40px;height:20px;flex:none}
.grid{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:18px}
figure{margin:0;background:var(--card);border:1px solid var(--rule);border-radius:8px;padding:12px 14px;min-width:0;
display:flex;flex-direction:column}
figure h3{margin-bottom:2px}
figcaption{font-size:.88rem;line-height:1.4}
.chart{display:block;width:100%;height:auto;margin-top:auto;padding-top:8px}
.chart text,.mark text{font-family:inherit;fill:var(--soft);font-size:13px}
.chart .label{fill:var(--ink);font-size:14px}
.chart .letter,.mark .letter{fill:var(--baseline);font-weight:700;font-size:14px}
.chart .limit-label{fill:var(--key)}
svg .grid{stroke:var(--grid)}
svg .axis{stroke:var(--soft)}
svg .break{stroke:var(--rule);stroke-dasharray:2 4}
svg .limit{stroke:var(--key);stroke-dasharray:7 5;stroke-width:1.5}
svg .line{fill:none;stroke-width:2}
svg .point{stroke:var(--card);stroke-width:1.5}
svg .point:hover{stroke:var(--ink)}
svg .point text{stroke:none}
svg .error{stroke-width:2}
svg .chosen{fill:none;stroke:var(--key);stroke-width:2.5}
)"
                                     R"(
.f0{fill:var(--f0)}.f1{fill:var(--f1)}.f2{fill:var(--f2)}.f3{fill:var(--f3)}.f4{fill:var(--f4)}
.line.f0,.f0 .error{stroke:var(--f0)}.line.f1,.f1 .error{stroke:var(--f1)}.line.f2,.f2 .error{stroke:var(--f2)}
.line.f3,.f3 .error{stroke:var(--f3)}.line.f4,.f4 .error{stroke:var(--f4)}
svg .line.f0{stroke-width:3.5}
.r0,.r1,.r2,.r3,.r4{fill:var(--card)}
svg .r0.point,svg .r1.point,svg .r2.point,svg .r3.point,svg .r4.point{stroke:var(--baseline);stroke-width:2}
svg .line.r0,svg .line.r1,svg .line.r2,svg .line.r3,svg .line.r4{stroke:var(--baseline);stroke-width:1.5;
stroke-dasharray:4 4}
[class*="point r"] .error{stroke:var(--baseline)}
.pictures img{display:block;width:100%;height:auto;margin-top:auto;border-radius:3px}
.pictures h3{margin-bottom:8px}
.scale{display:flex;align-items:center;gap:10px;margin:12px 0 0;font-size:.88rem;color:var(--soft)}
.scale img{flex:1;max-width:420px;min-width:60px;height:14px;border-radius:3px}
.scroll{overflow-x:auto;border:1px solid var(--rule);border-radius:8px;background:var(--card)}
table{border-collapse:collapse;width:100%;font-size:.88rem;font-variant-numeric:tabular-nums}
th,td{padding:6px 12px;text-align:right;border-bottom:1px solid var(--grid);white-space:nowrap}
th{font-weight:600;vertical-align:bottom;border-bottom-color:var(--rule)}
th:first-child,td:first-child{text-align:left}
td.text,th.text{text-align:left}
#renderers th{white-space:normal}
td.left{white-space:normal;min-width:190px}
tr.best td{background:var(--keybg);font-weight:600}
tr:last-child td{border-bottom:0}
td code{font-size:.84rem}
.won{color:var(--f2);font-weight:600}.lost{color:var(--f1);font-weight:600}
ul.say{padding-left:20px;margin:8px 0}
ul.say li{margin:5px 0;overflow-wrap:anywhere}
footer{padding:34px 20px 40px;font-size:.85rem}
@media (max-width:820px){.grid{grid-template-columns:minmax(0,1fr)}}
@media (max-width:600px){header,main,footer{padding-left:14px;padding-right:14px}.lead{font-size:1.15rem}
.advice{padding:14px 16px}h1{font-size:1.5rem}figure{padding:10px}.facts{grid-template-columns:1fr 1fr}
.chart text{font-size:18px}.chart .label,.chart .letter{font-size:18px}}
)";

} // namespace acdf::tools
